#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "datasets/images/features/features.hpp"

namespace loopbench::rgbd {
namespace {

constexpr float kOctave = 1.2f;      // scale factor of the ORB pyramid
constexpr int kMinLevelSize = 60;    // [px]; smaller levels contain no complete patch
constexpr int kCells = 12;           // columns of the grid for an even distribution
constexpr int kBorder = 19;          // ORB patch at the finest level [px]
constexpr float kDepthEdge = 0.06f;  // maximum relative depth difference around a feature

cv::Ptr<cv::Feature2D> detector(const FeatureOptions& o, int count, int shorter_side) {
  switch (o.kind) {
    case FeatureKind::akaze:
      return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, 0.0005f);
    case FeatureKind::sift:
      return cv::SIFT::create(count, 3, 0.02);
    case FeatureKind::orb:
      break;
  }
  int levels = 1;
  while (levels < 8 &&
         static_cast<double>(shorter_side) / std::pow(kOctave, levels) > kMinLevelSize)
    ++levels;
  return cv::ORB::create(count, kOctave, levels, kBorder, 0, 2, cv::ORB::HARRIS_SCORE, 31, 8);
}

/// Returns ascending indices of `count` points: the strongest of each grid cell, then the second
/// strongest, and so on.
std::vector<std::size_t> distribute(const std::vector<cv::KeyPoint>& points,
                                    std::size_t count,
                                    int width) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].response > points[b].response;
  });
  const float side = static_cast<float>(width) / static_cast<float>(kCells);
  std::map<std::pair<int, int>, std::size_t> filled;
  std::vector<std::pair<std::size_t, std::size_t>> ranked;  // rank in its cell, index
  for (const std::size_t i : order) {
    const auto x = static_cast<int>(points[i].pt.x / side);
    const auto y = static_cast<int>(points[i].pt.y / side);
    ranked.emplace_back(filled[{x, y}]++, i);
  }
  std::stable_sort(
      ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  ranked.resize(std::min(count, ranked.size()));
  std::vector<std::size_t> out;
  for (const auto& [rank, index] : ranked) out.push_back(index);
  std::sort(out.begin(), out.end());
  return out;
}

/// Median of the 3 x 3 depths around a pixel; 0 at depth edges, where foreground and background
/// mix.
float median_depth_at(const DepthImage& depth, float u, float v) {
  const int x = static_cast<int>(std::lround(u));
  const int y = static_cast<int>(std::lround(v));
  std::array<float, 9> found{};
  std::size_t count = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int a = x + dx;
      const int b = y + dy;
      if (a < 0 || b < 0 || a >= depth.width || b >= depth.height) continue;
      if (depth.at(a, b) > 0.0f) found[count++] = depth.at(a, b);
    }
  }
  if (count < 3) return 0.0f;
  std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
  const float middle = found[count / 2];
  return found[count - 1] - found[0] < kDepthEdge * middle ? middle : 0.0f;
}

std::vector<cv::Point2f> undistorted(const std::vector<cv::KeyPoint>& points, const Camera& c) {
  std::vector<cv::Point2f> out;
  for (const cv::KeyPoint& point : points) out.push_back(point.pt);
  if (!c.distorted() || out.empty()) return out;
  const cv::Matx33d K(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Vec<double, 5> d(c.k1, c.k2, c.p1, c.p2, c.k3);
  std::vector<cv::Point2f> rectified;
  cv::undistortPoints(out, rectified, K, d, cv::noArray(), K);
  return rectified;
}

}  // namespace

Features find_features(const RgbdFrame& frame, const Camera& camera, const FeatureOptions& o) {
  const cv::Mat image(frame.grey.height,
                      frame.grey.width,
                      CV_8U,
                      const_cast<std::uint8_t*>(frame.grey.pixels.data()));  // not modified
  const auto count = static_cast<std::size_t>(o.count);
  const auto algorithm = detector(o, static_cast<int>(4 * count), std::min(image.cols, image.rows));
  std::vector<cv::KeyPoint> all;
  algorithm->detect(image, all);
  std::vector<cv::KeyPoint> kept;
  for (const std::size_t i : distribute(all, count, image.cols)) {
    kept.push_back(all[i]);
  }
  cv::Mat rows;
  algorithm->compute(image, kept, rows);                   // may drop points at the border
  if (rows.type() == CV_32F) rows.convertTo(rows, CV_8U);  // SIFT values are integers 0..255

  Features out;
  out.binary = o.kind != FeatureKind::sift;
  out.bytes = rows.empty() ? 32 : rows.cols;
  const std::vector<cv::Point2f> pixels = undistorted(kept, camera);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const cv::KeyPoint& point = kept[i];
    // Feature size at the finest level [px]; ORB reports its patch size of 31 px.
    float finest = o.kind == FeatureKind::akaze ? 4.8f : 3.2f;
    if (o.kind == FeatureKind::orb) finest = 31.0f;
    const float sigma = std::max(1.0f, point.size / finest);
    const float depth = median_depth_at(frame.depth, point.pt.x, point.pt.y);
    out.points.push_back(
        {pixels[i].x,
         pixels[i].y,
         depth < static_cast<float>(o.depth_max) ? depth : 0.0f,
         sigma,
         static_cast<std::int32_t>(std::lround(std::log(sigma) / std::log(kOctave)))});
    const std::uint8_t* row = rows.ptr<std::uint8_t>(static_cast<int>(i));
    out.descriptors.insert(out.descriptors.end(), row, row + rows.cols);
  }
  return out;
}

}  // namespace loopbench::rgbd
