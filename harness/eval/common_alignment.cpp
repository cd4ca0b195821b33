#include "harness/eval/common_alignment.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "harness/eval/recorded_file.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::harness {
namespace {

using Group = std::pair<std::string, std::string>;  // method and run; empty: all files

void require_least_squares(const metrics::NamedProtocol& protocol) {
  const metrics::Align type = protocol.rules.align;
  const bool is_fitted = type == metrics::Align::se3 || type == metrics::Align::sim3 ||
                         type == metrics::Align::scale || type == metrics::Align::posyaw;
  if (is_fitted && protocol.rules.align_first == 0) return;
  throw InputError("--align-together: protocol " + protocol.label() +
                   " does not align by least squares of all pairs, expected --align se3, sim3, "
                   "scale or posyaw");
}

void append(metrics::Paired& all, const metrics::Paired& more) {
  all.reference.insert(all.reference.end(), more.reference.begin(), more.reference.end());
  all.estimate.insert(all.estimate.end(), more.estimate.begin(), more.estimate.end());
}

}  // namespace

std::vector<std::vector<metrics::Alignment>> common_alignments(const RecordedSweep& files) {
  const std::vector<metrics::NamedProtocol>& protocols = files.sweep.protocols;
  std::ranges::for_each(protocols, require_least_squares);
  const bool has_one = std::ranges::all_of(files.runs, [&](const RecordedRun& run) {
    return run.reference == files.runs.front().reference;
  });
  const auto group_of = [&](const RecordedRun& run) {
    return has_one ? Group() : Group(run.method, run.run);
  };
  std::map<Group, std::vector<metrics::Paired>> pairs;  // of each protocol
  std::string why;
  for (const RecordedRun& run : files.runs) {
    std::vector<metrics::Paired>& of_group = pairs[group_of(run)];
    of_group.resize(protocols.size());
    try {
      const RecordedFile reference = recorded_reference(run.reference, files.arguments, false);
      const RecordedFile estimate =
          recorded_estimate(run.estimate, files.arguments, false, &reference);
      for (std::size_t p = 0; p < protocols.size(); ++p) {
        append(of_group[p],
               metrics::associate(reference.poses, estimate.poses, protocols[p].rules));
      }
    } catch (const std::runtime_error& error) {
      why = error.what();  // its evaluation fails, too
    }
  }
  std::map<Group, std::vector<metrics::Alignment>> fitted;
  for (const auto& [group, of_group] : pairs) {
    for (std::size_t p = 0; p < protocols.size(); ++p) {
      try {
        fitted[group].push_back(
            align(of_group[p].reference, of_group[p].estimate, protocols[p].rules.align));
      } catch (const std::exception& error) {
        throw InputError("--align-together: " + (why.empty() ? error.what() : why));
      }
    }
  }
  std::vector<std::vector<metrics::Alignment>> out;
  for (const RecordedRun& run : files.runs) out.push_back(fitted.at(group_of(run)));
  return out;
}

}  // namespace loopbench::harness
