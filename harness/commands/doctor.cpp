#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/derive/closures.hpp"
#include "datasets/derive/graph_parts.hpp"
#include "datasets/formats/g2o.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/commands/options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::harness {
namespace {

struct DoctorArguments {
  std::string reference;
  std::vector<std::string> estimates;
  ReadArguments reading;
  std::optional<Format> reference_format;  ///< none: same as that of the estimates
  std::string loops;                       ///< closures of a trajectory; empty: none
  bool json = false;
};

struct Diagnosed {
  std::string name;
  metrics::Diagnosis result;
};

Diagnosed of_closures(const std::string& name,
                      const Problem& problem,
                      std::vector<metrics::InputFinding> findings) {
  Diagnosed out{name, {}};
  out.result.findings = std::move(findings);
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  const bool is_judged = methods::why_not_judged(problem).empty();
  out.result.has_checked = (is_chain || is_judged) && !problem.closures.empty();
  if (!out.result.has_checked) {
    out.result.unchecked.emplace_back(problem.closures.empty()
                                          ? "closures, information: there are no closures"
                                          : "closures, information: the odometry is no chain");
  }
  return out;
}

/// Closures of a trajectory.
Diagnosed of_loops(const std::string& trajectory, const std::string& loops) {
  if (std::filesystem::path(loops).extension() != ".g2o") {
    std::vector<double> stamps;
    for (const StampedClosure& closure : read_closure_file(loops, {})) {
      stamps.insert(stamps.end(), {closure.stamp_from, closure.stamp_to});
    }
    if (auto found = metrics::check_loop_stamps(stamps, read_named(trajectory, {}).file.poses)) {
      return {loops, {.findings = {std::move(*found)}}};
    }
  }
  const Problem problem = load_problem({.estimate = trajectory, .loops = loops}, catalogue({}));
  return of_closures(loops, problem, metrics::check_closures(problem));
}

Diagnosed of_graph(const std::string& file) {
  const PoseGraph graph = read_g2o(file, {.indefinite = IndefiniteInformation::project});
  GraphParts parts = split_graph(graph, file);
  const Problem problem{.keyframes = initial_poses(graph, ReadOptions{}.period),
                        .odometry = std::move(parts.odometry),
                        .closures = std::move(parts.closures),
                        .ids = graph.ids};
  Diagnosed out = of_closures(file, problem, metrics::check_closures(problem));
  if (graph.altered > 0) {  // other commands refuse such a graph
    std::erase_if(out.result.findings, [](const metrics::InputFinding& finding) {
      return finding.fault == metrics::Fault::information;  // of what is left of it
    });
    out.result.findings.push_back(
        {metrics::Fault::information,
         fmt::format("the information of {} of {} edges is not positive definite",
                     graph.altered,
                     graph.edges.size()),
         "option indefinite of dataset pose_graph: repair or project",
         1.0,
         static_cast<double>(graph.altered)});
  }
  return out;
}

Diagnosed of_pair(const NamedTrajectory& reference,
                  const NamedTrajectory& estimate,
                  bool is_repeat_handled) {
  const bool has_stamps = reference.file.has_stamps && estimate.file.has_stamps;
  Diagnosed out{
      estimate.name,
      metrics::diagnosis(
          reference.file.poses, estimate.file.poses, reference.name, estimate.name, has_stamps)};
  for (const NamedTrajectory* file : {&reference, &estimate}) {
    const std::size_t count = file->findings.repeated;
    if (count == 0 || is_repeat_handled) continue;
    out.result.unchecked.push_back(fmt::format(
        "{}: {} with the same stamp as the pose before (--repeats keep_first or keep_last)",
        file->name,
        counted(count, "pose")));
  }
  return out;
}

/// "2 findings: scale, axes".
std::string headline(const metrics::Diagnosis& result) {
  if (result.findings.empty())
    return result.has_checked ? "nothing found" : "nothing could be checked";
  std::vector<std::string_view> kinds;
  for (const auto& found : result.findings) kinds.push_back(found.fault);
  return fmt::format("{}: {}", counted(kinds.size(), "finding"), fmt::join(kinds, ", "));
}

std::string report_text(const std::vector<Diagnosed>& all) {
  std::string out;
  for (const Diagnosed& each : all) {
    out += each.name + ": " + headline(each.result) + "\n";
    for (const auto& found : each.result.findings) out += "  " + fitted(text(found)) + "\n";
    for (const std::string& part : each.result.unchecked)
      out += "  " + fitted("not checked: " + part) + "\n";
  }
  return out;
}

std::string report_json(const std::vector<Diagnosed>& all) {
  nlohmann::json out = nlohmann::json::array();
  for (const Diagnosed& each : all) {
    nlohmann::json findings = nlohmann::json::array();
    for (const metrics::InputFinding& finding : each.result.findings) {
      findings.push_back({{"fault", finding.fault},
                          {"evidence", finding.evidence},
                          {"fix", finding.fix},
                          {"confidence", finding.confidence},
                          {"value", finding.value}});
    }
    out.push_back({{"file", each.name},
                   {"findings", findings},
                   {"unchecked", each.result.unchecked},
                   {"has_checked", each.result.has_checked}});
  }
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int doctor(const DoctorArguments& a) {
  std::vector<Diagnosed> all;
  if (!a.estimates.empty()) {
    ReadArguments reading = a.reading;
    reading.repeats = reading.repeats.value_or(Repeats::keep_first);
    ReadArguments of_reference = reading;
    of_reference.format = a.reference_format.value_or(reading.format);
    const NamedTrajectory reference = read_named(a.reference, of_reference);
    for (const NamedTrajectory& estimate : read_all_named(a.estimates, reading)) {
      all.push_back(of_pair(reference, estimate, a.reading.repeats.has_value()));
    }
  }
  if (!a.loops.empty()) {
    if (a.estimates.size() > 1) throw InputError("--loops: expected one trajectory");
    const std::string& owner = a.estimates.empty() ? a.reference : a.estimates.front();
    all.push_back(of_loops(owner, a.loops));
  } else if (a.estimates.empty()) {
    if (detect_format(a.reference) != Format::g2o) {
      throw InputError(a.reference +
                       ": expected REF EST, a trajectory with --loops, or a g2o graph");
    }
    all.push_back(of_graph(a.reference));
  }
  fmt::print("{}", a.json ? report_json(all) : printable(report_text(all)));
  const bool is_clean = std::ranges::all_of(all, [](const Diagnosed& each) {
    return each.result.findings.empty() && each.result.has_checked;
  });
  return is_clean ? kExitOk : kExitSomeCellsFailed;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<DoctorArguments>();
  CLI::App* command = app.add_subcommand(
      "doctor",
      "Find mistakes in trajectory files or a pose graph: time offset, units, axes, quaternion "
      "order, another body, exchanged or wrong files, jumps, false closures, information matrices");
  add(*command,
      "reference REF",
      a->reference,
      "Reference trajectory, pose graph, or (with --loops) the estimate itself")
      ->required();
  add(*command, "estimates EST", a->estimates, "Estimated trajectories");
  add(*command,
      "--loops FILE",
      a->loops,
      "Loop closures of EST (or of REF, if there is no EST), see `correct --help`");
  declare_reading(*command, a->reading, {"--times", "--period", "--all-topics"});
  add(*command,
      "--ref-format",
      a->reference_format,
      "File format of REF, if different from --format");
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a, &exit_code] { exit_code = doctor(*a); });
}

}  // namespace loopbench::harness
