#include <opencv2/features2d.hpp>

#include "datasets/images/features/matching.hpp"

namespace loopbench::rgbd {
namespace {

cv::Mat rows(const Features& features) {
  return {static_cast<int>(features.size()),
          features.bytes,
          CV_8U,
          const_cast<std::uint8_t*>(features.descriptors.data())};  // not modified
}

/// Returns for each row of `from` its nearest neighbour in `to`, -1 if it is too far or fails the
/// ratio test.
std::vector<int> nearest(const cv::Mat& from, const cv::Mat& to, double unit, int norm) {
  std::vector<std::vector<cv::DMatch>> found;
  cv::BFMatcher(norm).knnMatch(from, to, found, 2);
  std::vector<int> out(static_cast<std::size_t>(from.rows), -1);
  for (const std::vector<cv::DMatch>& pair : found) {
    if (pair.empty() || pair[0].distance > kMaxDistance * unit) continue;
    if (pair.size() > 1 && pair[0].distance > kMaxRatio * pair[1].distance) continue;
    out[static_cast<std::size_t>(pair[0].queryIdx)] = pair[0].trainIdx;
  }
  return out;
}

}  // namespace

std::vector<Match> match_exhaustive(const Features& a, const Features& b) {
  if (a.size() == 0 || b.size() == 0) return {};
  const int norm = a.binary ? cv::NORM_HAMMING : cv::NORM_L2;
  const double unit = a.binary ? 8.0 * a.bytes : 1024.0;
  const std::vector<int> forward = nearest(rows(a), rows(b), unit, norm);
  const std::vector<int> backward = nearest(rows(b), rows(a), unit, norm);
  std::vector<Match> out;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    if (forward[i] < 0) continue;
    const auto k = static_cast<std::size_t>(forward[i]);
    if (backward[k] == static_cast<int>(i)) out.push_back({i, k, descriptor_distance(a, i, b, k)});
  }
  return out;
}

}  // namespace loopbench::rgbd
