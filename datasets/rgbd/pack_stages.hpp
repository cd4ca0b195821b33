/// Serialisation of the results of front-end stages.
#pragma once

#include <string>

#include "datasets/rgbd/dense/refine_by_depth.hpp"
#include "datasets/rgbd/features/features.hpp"
#include "datasets/rgbd/loops/detector.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench::rgbd {

/// Features of a frame, or the reason why it could not be read.
struct FrameFeatures {
  std::optional<Features> features = std::nullopt;
  std::string why = {};
};

/// For FrameFeatures, TrackingResult, DetectedLoops and RefinedEdges. deserialised() throws
/// std::runtime_error for bytes in another layout.
template <class T>
std::string serialised(const T& value);
template <class T>
T deserialised(const std::string& bytes);

}  // namespace loopbench::rgbd
