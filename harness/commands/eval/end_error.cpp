#include "harness/commands/eval/end_error.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "datasets/core/se3.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::harness {

std::string end_errors(const std::vector<std::string>& files,
                       const ReadArguments& reading,
                       bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::string out;
  for (const std::string& name : files) {
    const Trajectory poses = read_named(name, reading).file.poses;
    const Pose& first = poses.front().world_from_body;
    const Pose& last = poses.back().world_from_body;
    const double length = path_length(poses),
                 metres = (last.translation - first.translation).norm();
    if (!(length > 0.0)) throw InputError(name + ": does not move, --end-error needs a path");
    nlohmann::ordered_json& each =
        all.emplace_back(nlohmann::ordered_json{{"estimate", name},
                                                {"translation_m", metres},
                                                {"share_percent", 100.0 * metres / length},
                                                {"length_m", length}});
    out += fmt::format("{}: the last pose is {:.4g} m", name, metres);
    if (has_rotation(first)) {
      const double degrees =
          metrics::kDegrees * log_so3(first.rotation.conjugate() * last.rotation).norm();
      each["rotation_deg"] = degrees;
      out += fmt::format(" and {:.4g} deg", degrees);
    }
    out += fmt::format(
        " from the first, {:.4g} % of a path of {:.4g} m\n", 100.0 * metres / length, length);
  }
  return json ? all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n" : out;
}

}  // namespace loopbench::harness
