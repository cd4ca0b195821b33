#include "datasets/images/dense/surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "datasets/core/upper_median.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

constexpr float kSameDepth = 0.02f;      // relative depth difference to the median of a block
constexpr int kNormalReach = 2;          // half size of the patch of a normal [px]
constexpr float kNormalDepth = 0.04f;    // relative depth difference to the centre of a patch
constexpr int kMinNormalPoints = 15;     // of 25
constexpr double kFlat = 0.05;           // ratio of the two smallest variances of a patch
constexpr double kFlatNoisy = 0.25;      // the same if the smallest one is below the noise
constexpr float kGrazingSight = 0.2f;    // minimum cosine between normal and ray
constexpr float kMinValidDepth = 0.05f;  // [m]

/// Maps an undistorted pixel to the distorted image (Brown's model).
Eigen::Vector2d distorted_pixel(const Camera& c, double u, double v) {
  const double x = (u - c.cx) / c.fx;
  const double y = (v - c.cy) / c.fy;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  return {c.fx * (x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x)) + c.cx,
          c.fy * (y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y) + c.cy};
}

DepthImage undistorted(const DepthImage& depth, const Camera& camera) {
  DepthImage out(depth.width, depth.height);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const Eigen::Vector2d from = distorted_pixel(camera, x, y);
      const auto u = static_cast<int>(std::lround(from.x()));
      const auto v = static_cast<int>(std::lround(from.y()));
      if (u >= 0 && v >= 0 && u < depth.width && v < depth.height) out.at(x, y) = depth.at(u, v);
    }
  }
  return out;
}

/// Mean of the depths near their median; 0 if less than half of the block is measured.
float block_depth(std::vector<float>& measured, std::size_t pixels) {
  if (2 * measured.size() < pixels) return 0.0f;
  const float median = upper_median(measured);
  float sum = 0.0f;
  std::size_t count = 0;
  for (const float z : measured) {
    if (std::abs(z - median) > kSameDepth * median) continue;
    sum += z;
    ++count;
  }
  return 2 * count > measured.size() ? sum / static_cast<float>(count) : 0.0f;
}

Eigen::Vector3f normal_at(const Surface& surface, int x, int y) {
  const auto at = [&](int column, int row) -> const Eigen::Vector3f& {
    return surface.points[static_cast<std::size_t>(row * surface.camera.width + column)];
  };
  const Eigen::Vector3f& centre = at(x, y);
  if (!(centre.z() > 0.0f)) return Eigen::Vector3f::Zero();
  Vector3 mean = Vector3::Zero();
  Matrix3 covariance = Matrix3::Zero();
  int count = 0;
  for (int row = y - kNormalReach; row <= y + kNormalReach; ++row) {
    for (int column = x - kNormalReach; column <= x + kNormalReach; ++column) {
      const Eigen::Vector3f& p = at(column, row);
      if (!(p.z() > 0.0f) || std::abs(p.z() - centre.z()) > kNormalDepth * centre.z()) continue;
      const Vector3 d = (p - centre).cast<double>();
      mean += d;
      covariance += d * d.transpose();
      ++count;
    }
  }
  if (count < kMinNormalPoints) return Eigen::Vector3f::Zero();
  mean /= count;
  covariance = (covariance / count - mean * mean.transpose()).eval();
  Eigen::SelfAdjointEigenSolver<Matrix3> axes;
  axes.computeDirect(covariance);
  const double across = axes.eigenvalues()(0);
  const double along = axes.eigenvalues()(1);
  const auto z = static_cast<double>(centre.z());
  const double noise = surface.inverse_depth_sigma * z * z;
  const double max_ratio = across < noise * noise ? kFlatNoisy : kFlat;
  if (across > max_ratio * along) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f n = axes.eigenvectors().col(0).cast<float>().normalized();
  const float facing = -n.dot(centre.normalized());
  if (std::abs(facing) < kGrazingSight) return Eigen::Vector3f::Zero();
  return facing > 0.0f ? n : Eigen::Vector3f(-n);
}

}  // namespace

DownsampledDepth downsample_depth(const DepthImage& depth,
                                  const Camera& camera,
                                  int width,
                                  double depth_max) {
  const DepthImage rectified = camera.distorted() ? undistorted(depth, camera) : DepthImage();
  const DepthImage& from = camera.distorted() ? rectified : depth;
  const int block = std::max(1, (depth.width + width - 1) / width);
  const double scale = 1.0 / block;
  DownsampledDepth out;
  out.block = block;
  out.camera.width = depth.width / block;
  out.camera.height = depth.height / block;
  out.camera.fx = scale * camera.fx;
  out.camera.fy = scale * camera.fy;
  out.camera.cx = scale * (camera.cx + 0.5) - 0.5;  // pixel (0, 0) is the centre of the first block
  out.camera.cy = scale * (camera.cy + 0.5) - 0.5;
  out.depth = DepthImage(out.camera.width, out.camera.height);
  std::vector<float> measured;
  for (int y = 0; y < out.depth.height; ++y) {
    for (int x = 0; x < out.depth.width; ++x) {
      measured.clear();
      for (int v = y * block; v < (y + 1) * block; ++v) {
        for (int u = x * block; u < (x + 1) * block; ++u) {
          const float z = from.at(u, v);
          if (z > kMinValidDepth && z < static_cast<float>(depth_max)) measured.push_back(z);
        }
      }
      out.depth.at(x, y) = block_depth(measured, static_cast<std::size_t>(block * block));
    }
  }
  return out;
}

Surface surface_of(const DownsampledDepth& image) {
  const DepthImage& depth = image.depth;
  Surface out;
  out.camera = image.camera;
  out.camera.width = depth.width;  // empty without an image
  out.camera.height = depth.height;
  out.inverse_depth_sigma = kInverseDepthSigma / image.block;
  out.points.assign(depth.pixels.size(), Eigen::Vector3f::Zero());
  out.normals.assign(depth.pixels.size(), Eigen::Vector3f::Zero());
  const auto index = [&](int x, int y) { return static_cast<std::size_t>(y * depth.width + x); };
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const auto z = static_cast<double>(depth.at(x, y));
      if (z > 0.0) out.points[index(x, y)] = image.camera.back_project(x, y, z).cast<float>();
    }
  }
  for (int y = kNormalReach; y + kNormalReach < depth.height; ++y) {
    for (int x = kNormalReach; x + kNormalReach < depth.width; ++x) {
      out.normals[index(x, y)] = normal_at(out, x, y);
    }
  }
  return out;
}

}  // namespace loopbench::rgbd
