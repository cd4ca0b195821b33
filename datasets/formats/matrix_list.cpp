#include "datasets/formats/matrix_list.hpp"

#include "datasets/columns/pose_matrix.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/formats/times.hpp"

namespace loopbench {

TrajectoryFile poses_of_matrices(const std::string& file,
                                 const std::vector<ListedMatrix>& matrices,
                                 const ReadOptions& options,
                                 ReadFindings findings) {
  TrajectoryFile out;
  const auto error = [&](const ListedMatrix& each, const std::string& why) {
    return input_error(file, 0, each.name + ": " + why);
  };
  for (const ListedMatrix& each : matrices) {
    const std::size_t row = findings.rows++;
    if (is_missing(each.pose)) {
      const InvalidRow invalid(error(each, "has no pose, expected finite numbers and a rotation"));
      if (!options.drop_invalid) throw with_remedy(invalid);
      ++findings.invalid;
      findings.dropped.push_back(row);
      continue;
    }
    PoseMatrix pose = each.pose;
    const std::string why = normalise_matrix(pose, findings);
    if (!why.empty()) throw error(each, why);
    out.poses.push_back({each.number, pose_of(pose)});
  }
  if (findings.clock != Clock::stamps && !out.poses.empty()) {
    set_stamps(file, options, findings, out.poses);
  }
  out.has_stamps = findings.clock == Clock::stamps;
  if (!options.sort) check(out.poses, file);
  if (options.findings) *options.findings = std::move(findings);
  return out;
}

}  // namespace loopbench
