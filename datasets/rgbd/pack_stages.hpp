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

/// The deserialise_* functions throw std::runtime_error for bytes in another layout.
std::string packed(const FrameFeatures& frame);
FrameFeatures deserialise_frame(const std::string& bytes);
std::string packed(const TrackingResult& tracked);
TrackingResult deserialise_tracked(const std::string& bytes);
std::string packed(const DetectedLoops& loops);
DetectedLoops deserialise_loops(const std::string& bytes);
std::string packed(const RefinedEdges& edges);
RefinedEdges deserialise_edges(const std::string& bytes);

}  // namespace loopbench::rgbd
