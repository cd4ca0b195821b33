#include "harness/commands/traj_pairs.hpp"

#include <fmt/format.h>

#include "harness/trajectory/clocks.hpp"

namespace loopbench::harness {

void reject_two_clocks(const TrajArguments& a,
                       const NamedTrajectory& one,
                       const NamedTrajectory& other) {
  const std::string why = why_no_common_clock(one, other, a.reading);
  if (!why.empty()) throw InputError(why);
}

std::vector<metrics::IndexPair> paired_indices(const TrajArguments& a,
                                               const NamedTrajectory& reference,
                                               const NamedTrajectory& estimate) {
  using metrics::Crossing;
  using metrics::Limit;
  reject_two_clocks(a, reference, estimate);
  const std::vector<double> of_reference = stamps(reference.file.poses);
  const std::vector<double> of_estimate = stamps(estimate.file.poses);
  const std::vector<metrics::IndexPair> out =
      a.association == "evo" ? metrics::match_evo(of_reference, of_estimate, a.max_diff, a.offset)
                             : metrics::match_one_to_one(of_reference,
                                                         of_estimate,
                                                         a.max_diff,
                                                         Limit::inclusive,
                                                         Crossing::refused,
                                                         a.offset);
  if (!out.empty()) return out;
  throw InputError(fmt::format(
      "{}: no stamps are within {:g} s of stamps of {}", estimate.name, a.max_diff, a.reference));
}

TrajectoryFile paired_part(const TrajectoryFile& file,
                           const std::vector<metrics::IndexPair>& pairs,
                           std::size_t metrics::IndexPair::*index) {
  std::vector<std::size_t> indices;
  for (const metrics::IndexPair& pair : pairs) indices.push_back(pair.*index);
  return selected(file, indices);
}

}  // namespace loopbench::harness
