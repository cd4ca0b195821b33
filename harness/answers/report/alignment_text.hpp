/// Titles of figures.
#pragma once

#include <string>

namespace loopbench::harness {

/// What an alignment (the name of a metrics::Align) did to the estimates: "aligned by rotation and
/// translation". Another name as it is.
inline std::string alignment_text(const std::string& type) {
  if (type == "none") return "not aligned";
  if (type == "se3") return "aligned by rotation and translation";
  if (type == "sim3") return "aligned by rotation, translation and scale";
  if (type == "scale") return "aligned by scale alone";
  if (type == "posyaw") return "aligned by translation and yaw";
  if (type == "origin") return "aligned at the first pose";
  if (type == "posyaw_origin") return "aligned at the first position and yaw";
  return type + " alignment";
}

}  // namespace loopbench::harness
