/// Where frames come from: a folder and a renderer are the same to whoever tracks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "datasets/core/sequence.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"

namespace loopbench {

class RgbdSource {
 public:
  virtual ~RgbdSource() = default;

  virtual Camera camera() const = 0;
  virtual std::size_t size() const = 0;
  virtual double stamp(std::size_t index) const = 0;  ///< [s], strictly increasing

  /// Frame `index`, or nothing with the reason in `why` when its images are missing or broken.
  /// Thread-safe. Same bits every time. O(pixels).
  virtual std::optional<RgbdFrame> read(std::size_t index, std::string& why) const = 0;

  /// Changes with everything that read() depends on: key of what is cached.
  virtual std::uint64_t content() const = 0;

  virtual const Trajectory& reference() const = 0;  ///< of the camera; may be empty
  virtual Provenance provenance() const = 0;
};

}  // namespace loopbench
