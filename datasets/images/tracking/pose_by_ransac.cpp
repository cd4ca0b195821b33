#include <opencv2/calib3d.hpp>

#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kIterations = 200;
constexpr float kMaxReprojection = 4.0f;  // of an inlier [px]

}  // namespace

std::optional<Pose> pose_by_ransac(const std::vector<Observation>& observations,
                                   const Camera& camera) {
  if (observations.size() < 4) return std::nullopt;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const Observation& o : observations) {
    points.emplace_back(o.in_world.x(), o.in_world.y(), o.in_world.z());
    pixels.emplace_back(o.u, o.v);
  }
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::theRNG().state = 1;
  cv::Vec3d rotation;
  cv::Vec3d translation;
  std::vector<int> inliers;
  try {
    const bool found = cv::solvePnPRansac(points,
                                          pixels,
                                          K,
                                          cv::noArray(),
                                          rotation,
                                          translation,
                                          false,
                                          kIterations,
                                          kMaxReprojection,
                                          0.999,
                                          inliers,
                                          cv::SOLVEPNP_AP3P);
    if (!found || inliers.size() < 4) return std::nullopt;
  } catch (const cv::Exception&) {  // thrown by OpenCV for degenerate points
    return std::nullopt;
  }
  const Pose camera_from_world{exp_so3({rotation[0], rotation[1], rotation[2]}),
                               {translation[0], translation[1], translation[2]}};
  if (!is_finite(camera_from_world)) return std::nullopt;
  return normalized(camera_from_world.inverse());
}

}  // namespace loopbench::rgbd
