#include "datasets/core/error.hpp"
#include "datasets/images/features/features.hpp"
#include "datasets/images/features/matching.hpp"
#include "datasets/images/folder/read_image.hpp"
#include "datasets/images/opencv.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {

bool has_opencv() { return false; }

void run_opencv_on_one_thread() {}

Features find_features(const RgbdFrame&, const Camera&, const FeatureOptions&) {
  throw MissingPart(kWithoutOpencv);
}

std::vector<Match> match_exhaustive(const Features&, const Features&) {
  throw MissingPart(kWithoutOpencv);
}

std::optional<Pose> pose_by_ransac(const std::vector<Observation>&, const Camera&) {
  throw MissingPart(kWithoutOpencv);
}

GreyImage read_grey(const std::filesystem::path&) { throw MissingPart(kWithoutOpencv); }

Image<std::uint16_t> read_depth(const std::filesystem::path&) { throw MissingPart(kWithoutOpencv); }

}  // namespace loopbench::rgbd
