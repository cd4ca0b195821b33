// Plants each fault of metrics/doctor in every real sequence and prints how often it is found, and
// how often a finding is reported on the unmodified data:
//   build/release/tests/studies/planted_faults DATA > results/doctor/README.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "methods/correctors/pose_graph.hpp"
#include "metrics/doctor/closure_checks.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/movement.hpp"
#include "tests/studies/planted_edges.hpp"
#include "tests/studies/planted_poses.hpp"

using namespace loopbench;
using namespace loopbench::metrics;
namespace fs = std::filesystem;

namespace {

std::vector<InputFinding> findings(const Recording& r) {
  return diagnose(r.reference, r.estimate, r.reference_name, r.estimate_name, r.has_stamps);
}

bool has(const std::vector<InputFinding>& all, Fault fault) {
  return std::ranges::any_of(all, [&](const InputFinding& f) { return f.fault == fault; });
}

/// Root mean square difference of the angles that both trajectories turn within a second [deg].
double turn_difference(const Recording& r, double offset) {
  const CommonPoses poses = common_poses(r.reference, r.estimate, offset, 2000);
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < poses.stamps.size(); ++i) {
    while (j < poses.stamps.size() && poses.stamps[j] < poses.stamps[i] + 1.0) ++j;
    if (j == poses.stamps.size()) break;
    const auto angle = [&](const std::vector<Pose>& list) {
      return list[i].rotation.angularDistance(list[j].rotation);
    };
    squares += std::pow(angle(poses.reference) - angle(poses.estimate), 2);
    ++count;
  }
  return 180.0 / M_PI * std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

/// Whether a finding on unmodified data is confirmed by other means; appends these to `evidence`.
bool is_confirmed(const Recording& r, const InputFinding& finding, std::string& evidence) {
  if (finding.fault == Fault::scale) return is_monocular(r);
  if (finding.fault != Fault::time_offset) return false;
  const double before = turn_difference(r, 0.0);
  const double after = turn_difference(r, finding.value);
  evidence = fmt::format(
      ". Turns within a second differ by {:.2f} deg as read, by {:.2f} deg with the offset",
      before,
      after);
  return after < 0.6 * before;
}

struct Tally {
  std::size_t found = 0;
  std::size_t all = 0;
  std::vector<std::string> missed;
};

void add_to(Tally& tally,
            const std::vector<InputFinding>& found,
            Fault fault,
            const std::string& name) {
  if (has(found, fault)) {
    ++tally.found;
    return;
  }
  tally.missed.push_back(name);
  for (const InputFinding& each : found) tally.missed.back() += "\n  found " + text(each);
}

void print_row(const std::string& name, Fault fault, const Tally& t) {
  fmt::print(
      "| {} | {} | {} of {} | {:.1f} |\n",
      name,
      fault_name(fault),
      t.found,
      t.all,
      100.0 * static_cast<double>(t.found) / static_cast<double>(std::max<std::size_t>(1, t.all)));
  for (const std::string& missed : t.missed) fmt::print(stderr, "missed: {}: {}\n", name, missed);
}

/// Corrections of all graphs, with and without closures that have no weight.
struct Corrections {
  Tally tally;
  std::vector<std::string> alarms;
};

std::vector<InputFinding> after_correction(const Problem& problem) {
  methods::PoseGraphOptimizer::Options options;
  options.max_iterations = 20;
  methods::Report report;
  const methods::PoseGraphOptimizer method(options);
  const auto found = check_movement(problem, method.correct(problem, report));
  return found ? std::vector{*found} : std::vector<InputFinding>{};
}

Corrections correct_all(const std::vector<std::pair<std::string, Problem>>& problems) {
  Corrections out;
  for (const auto& [name, problem] : problems) {
    for (const InputFinding& finding : after_correction(problem)) {
      out.alarms.push_back(name + ", corrected: " + text(finding));
    }
    Problem without_weight = problem;
    for (Edge& edge : without_weight.closures) edge.information *= 1e-20;
    ++out.tally.all;
    add_to(out.tally, after_correction(without_weight), Fault::nothing_moved, name);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: planted_faults DATA\n");
    return 2;
  }
  const fs::path data = argv[1];
  const std::vector<Recording> all = recordings(data);
  const auto problems = graphs(data);
  std::size_t false_alarms = 0, checks = 0;
  std::vector<std::string> alarms;
  std::vector<std::vector<InputFinding>> unmodified;
  for (const Recording& r : all) {
    unmodified.push_back(findings(r));
    bool is_alarm = false;
    for (const InputFinding& f : unmodified.back()) {
      std::string evidence;
      const bool is_true = is_confirmed(r, f, evidence);
      alarms.push_back(fmt::format("{}: {}{}{}",
                                   fs::path(r.estimate_name).lexically_relative(data).string(),
                                   is_true ? "(true) " : "",
                                   text(f),
                                   evidence));
      is_alarm |= !is_true;
    }
    ++checks;
    false_alarms += is_alarm ? 1 : 0;
  }
  for (const auto& [name, problem] : problems) {
    const auto found = check_closures(problem);
    for (const InputFinding& f : found) alarms.push_back(name + ": " + text(f));
    ++checks;
    false_alarms += found.empty() ? 0 : 1;
  }
  const Corrections corrections = correct_all(problems);
  for (const std::string& alarm : corrections.alarms) alarms.push_back(alarm);
  checks += problems.size();
  false_alarms += corrections.alarms.size();
  fmt::print("| planted fault | finding | found | found [%] |\n| --- | --- | ---: | ---: |\n");
  Tally sum;
  const auto add = [&](const std::string& name, Fault fault, const Tally& tally) {
    print_row(name, fault, tally);
    sum.found += tally.found;
    sum.all += tally.all;
  };
  for (const PlantedFault& each : faults()) {
    Tally tally;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool needs_stamps = each.fault == Fault::time_offset;
      if (needs_stamps && !all[i].has_stamps) continue;
      // The unit of a monocular estimate is arbitrary.
      if (each.fault == Fault::length_unit && is_monocular(all[i])) continue;
      Recording planted = all[i];
      each.plant(planted);
      ++tally.all;
      add_to(tally, findings(planted), each.fault, all[i].estimate_name);
    }
    add(each.name, each.fault, tally);
  }
  std::vector<std::string> left_out;
  for (const PlantedEdges& each : edge_faults()) {
    Tally tally;
    for (const auto& [name, problem] : problems) {
      if (const std::string reason = each.no_fault(problem); !reason.empty()) {
        left_out.push_back(fmt::format("{}: {}: {}", each.name, name, reason));
        continue;
      }
      Problem planted = problem;
      each.plant(planted);
      ++tally.all;
      add_to(tally, check_closures(planted), each.fault, name);
    }
    add(each.name, each.fault, tally);
  }
  add("closures without weight (information x 1e-20)", Fault::nothing_moved, corrections.tally);
  fmt::print("| all | | {} of {} | {:.1f} |\n",
             sum.found,
             sum.all,
             100.0 * static_cast<double>(sum.found) / static_cast<double>(sum.all));
  fmt::print("\nUnmodified: {} of {} data sets have a wrong finding ({:.1f} %).\n\n",
             false_alarms,
             checks,
             100.0 * static_cast<double>(false_alarms) / static_cast<double>(checks));
  for (const std::string& alarm : alarms) fmt::print("- {}\n", alarm);
  fmt::print("\nNot planted, because they are no fault there:\n\n");
  for (const std::string& each : left_out) fmt::print("- {}\n", each);
  return 0;
}
