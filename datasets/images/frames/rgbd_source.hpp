/// Interface of RGB-D frame sources: a folder or a renderer.
#pragma once

#include <optional>
#include <string>

#include "datasets/core/sequence.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

class RgbdSource {
 public:
  virtual ~RgbdSource() = default;

  virtual Camera camera() const = 0;
  virtual std::size_t size() const = 0;
  virtual double stamp(std::size_t index) const = 0;  ///< [s], strictly increasing

  /// Returns frame `index`. Returns nothing and writes the reason to `why` if an image is missing
  /// or corrupt. Thread-safe and bit-identical for repeated calls. O(pixels).
  virtual std::optional<RgbdFrame> read(std::size_t index, std::string& why) const = 0;

  virtual const Trajectory& reference() const = 0;  ///< world_from_camera; may be empty
  virtual Provenance provenance() const = 0;
};

}  // namespace loopbench::rgbd
