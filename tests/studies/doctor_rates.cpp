// Rates of `doctor`: accusations of right graphs, and planted faults that its findings name.
//   build/release/tests/studies/doctor_rates DATA FIRST_SEED CASES [-v] [KIND]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <string_view>

#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "tests/studies/edge_faults.hpp"
#include "tests/studies/pose_faults.hpp"

using namespace loopbench;
using namespace loopbench::metrics;

namespace {

using Findings = std::vector<InputFinding>;

constexpr const char *kRight = "~right", *kPoses = "~faults of trajectories",
                     *kGraphs = "~faults of graphs";

Findings findings_of(const Recording& r) {
  return diagnosis(r.reference, r.estimate, r.reference_name, r.estimate_name, r.has_stamps)
      .findings;
}

struct Tally {
  std::size_t named = 0;  ///< the planted fault is found
  std::size_t wrong = 0;  ///< something is found that was neither planted nor found without it
  std::size_t all = 0;
  std::size_t skipped = 0;  ///< within the noise
};

class Study {
 public:
  Study(bool is_verbose, std::string_view kind) : is_verbose_(is_verbose), kind_(kind) {}

  bool is_chosen(const std::string& fault) const { return fault.find(kind_) != fault.npos; }

  void count(const std::string& fault,
             const char* group,
             const std::string& file,
             const std::vector<std::string>& expected,
             const Findings& found,
             const Findings& as_read) {
    bool is_named = expected.empty() && found.empty(), is_wrong = false;
    for (const InputFinding& each : found) {
      const bool is_expected = std::ranges::count(expected, each.fault) > 0;
      const bool is_known = std::ranges::count(as_read, each.fault, &InputFinding::fault) > 0;
      is_named |= is_expected;
      is_wrong |= !is_expected && !is_known;
    }
    for (Tally* tally : {&tallies_[fault], &tallies_[group]}) {
      ++tally->all;
      tally->named += is_named ? 1 : 0;
      tally->wrong += is_wrong ? 1 : 0;
    }
    if (!is_verbose_ || (is_named && !is_wrong)) return;
    fmt::print(stderr, "{} {}: {}\n", is_named ? "extra" : "missed", fault, file);
    for (const InputFinding& each : found) fmt::print(stderr, "    {}\n", text(each));
  }

  /// Of faults within the noise, which show nothing.
  void skip(const std::string& fault, const char* group) {
    ++tallies_[fault].skipped;
    ++tallies_[group].skipped;
  }

  void print() const {
    fmt::print("| planted | within noise | cases | named [%] | wrong [%] |\n");
    fmt::print("| --- | ---: | ---: | ---: | ---: |\n");
    for (const auto& [name, t] : tallies_) {
      const double all = 0.01 * static_cast<double>(std::max<std::size_t>(1, t.all));
      fmt::print("| {} | {} | {} | {:.1f} | {:.1f} |\n",
                 name,
                 t.skipped,
                 t.all,
                 static_cast<double>(t.named) / all,
                 static_cast<double>(t.wrong) / all);
    }
  }

 private:
  bool is_verbose_;
  std::string_view kind_;
  std::map<std::string, Tally> tallies_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "usage: doctor_rates DATA FIRST_SEED CASES [-v] [KIND]\n");
    return 2;
  }
  const auto first = static_cast<unsigned>(std::atoi(argv[2]));
  const auto cases = static_cast<unsigned>(std::atoi(argv[3]));
  Study study(argc > 4 && std::string_view(argv[4]) == "-v", argc > 5 ? argv[5] : "");
  constexpr std::size_t kPlanted = 20, kRightPairs = 60;
  std::vector<Recording> pairs = recordings(argv[1]);
  std::vector<Recording> simulated = simulated_recordings(kPlanted + kRightPairs);
  for (std::size_t i = kPlanted; i < simulated.size(); ++i) {
    study.count("right: simulated pairs",
                kRight,
                simulated[i].estimate_name,
                {},
                findings_of(simulated[i]),
                {});
  }
  simulated.resize(kPlanted);
  std::ranges::move(simulated, std::back_inserter(pairs));
  const std::vector<NamedProblem> graphs = measured_graphs(argv[1]);
  std::vector<Findings> of_pairs, of_graphs;
  for (const Recording& r : pairs) {
    of_pairs.push_back(findings_of(r));
    study.count("right: measured", kRight, r.estimate_name, {}, of_pairs.back(), {});
  }
  for (const auto& [name, problem] : graphs) {
    of_graphs.push_back(check_closures(problem));
    study.count("right: measured", kRight, name, {}, of_graphs.back(), {});
  }
  const auto of_poses = pose_faults();
  const auto of_edges = edge_faults();
  for (unsigned seed = first; seed < first + cases; ++seed) {
    std::mt19937 random(seed);
    auto [name, graph] = simulated_graph(random);
    const Findings as_simulated = check_closures(graph);
    if (study.is_chosen("right: simulated"))
      study.count(
          "right: simulated", kRight, fmt::format("{} ({})", name, seed), {}, as_simulated, {});
    const PlantedEdges& fault = of_edges[random() % of_edges.size()];
    if (study.is_chosen(fault.name)) {
      const bool is_measured = !graphs.empty() && random() % 2 == 0;  // half of them
      const std::size_t file = graphs.empty() ? 0 : random() % graphs.size();
      const Problem& right = is_measured ? graphs[file].second : graph;
      Findings known = is_measured ? of_graphs[file] : as_simulated;
      Problem planted = right;
      if (fault.plant(planted, random) &&
          std::ranges::count(known, fault.expected, &InputFinding::fault) == 0) {
        const bool is_information = fault.expected == Fault::information;
        // Changed closures do contradict the odometry.
        if (!is_information) known.push_back({Fault::closure_gap, {}, {}});
        if (!is_information && !exceeds_noise(right, planted)) {
          study.skip(fault.name, kGraphs);
        } else {
          study.count(fault.name,
                      kGraphs,
                      is_measured ? graphs[file].first : fmt::format("{} ({})", name, seed),
                      {fault.expected},
                      check_closures(planted),
                      known);
        }
      }
    }
    const PlantedFault& of_pose = of_poses[random() % of_poses.size()];
    if (!study.is_chosen(of_pose.name)) continue;
    const std::size_t file = random() % pairs.size();
    Recording planted = pairs[file];
    if (!of_pose.plant(planted, random, pairs)) continue;
    if (of_pose.can_be_small && !exceeds_errors(pairs[file], planted)) {
      study.skip(of_pose.name, kPoses);
      continue;
    }
    study.count(of_pose.name,
                kPoses,
                fmt::format("{} ({})", planted.estimate_name, seed),
                of_pose.expected,
                findings_of(planted),
                of_pairs[file]);
  }
  study.print();
  return 0;
}
