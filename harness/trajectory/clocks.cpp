#include "harness/trajectory/clocks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/core/fields.hpp"

namespace loopbench::harness {

void shift_stamps(TrajectoryFile& file, double offset) {
  const auto nanoseconds = static_cast<std::int64_t>(std::llround(offset * 1e9));
  for (StampedPose& pose : file.poses) pose.stamp += offset;
  for (std::int64_t& stamp : file.nanoseconds) stamp += nanoseconds;
}

std::string why_no_common_clock(const NamedTrajectory& a,
                                const NamedTrajectory& b,
                                const ReadArguments& arguments) {
  if (arguments.period || a.file.has_stamps == b.file.has_stamps) return "";
  const NamedTrajectory& without = a.file.has_stamps ? b : a;
  const NamedTrajectory& with = a.file.has_stamps ? a : b;
  return fmt::format(
      "{}: is {}, poses without stamps, and {} has stamps: expected --period S, or a file with "
      "stamps (traj convert FILE --times TIMES -o NEW)",
      without.name,
      to_text(without.file.format),
      with.name);
}

std::string assumed_period(const TrajectoryFile& file, const ReadArguments& arguments) {
  if (file.has_stamps || arguments.period) return "";
  return fmt::format("assumed {:g} s between poses", ReadOptions{}.period);
}

}  // namespace loopbench::harness
