#include "harness/commands/correct/correct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "datasets/core/closure_places.hpp"
#include "datasets/core/covariance.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/planar.hpp"
#include "datasets/derive/problem_graph.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/g2o_prior_lines.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "methods/correctors/consensus.hpp"
#include "methods/correctors/consensus/judgement_text.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kConsensus = "consensus";

bool is_graph(const CorrectArguments& a) { return detect_format(a.estimate) == Format::g2o; }

/// Whether a stage of the method corrects keyframes by closures.
bool uses_closures(const MethodChoice& choice, const Catalogue& catalogue) {
  return std::ranges::any_of(choice.stages, [&](const Choice& stage) {
    if (stage.name == "raw" || is_oracle(catalogue, stage.name)) return false;
    if (is_program(stage)) return true;
    const methods::Kind kind = find_method(catalogue, stage.name).kind;
    return kind == methods::Kind::corrector || kind == methods::Kind::joint;
  });
}

/// Stamps of the output, ascending; those outside the keyframes' time span are only counted.
std::vector<double> output_stamps(const CorrectArguments& a,
                                  const Problem& problem,
                                  std::size_t& outside) {
  const Trajectory& keyframes = problem.keyframes;
  std::vector<double> wanted = stamps(keyframes);
  if (!a.at.empty()) {
    wanted = stamps(read_trajectory(a.at));
  } else if (a.dense) {
    for (const StampedPose& frame : problem.frames) wanted.push_back(frame.stamp);
    std::ranges::sort(wanted);
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  }
  if (keyframes.empty()) return wanted;
  const double start = keyframes.front().stamp, end = keyframes.back().stamp;
  const std::size_t all = wanted.size();
  std::erase_if(wanted, [&](double t) { return t < start || t > end; });
  outside = all - wanted.size();
  if (wanted.empty()) {
    throw InputError(fmt::format("{}: none of the {} stamps is between {} and {} s, the keyframes",
                                 a.at,
                                 all,
                                 to_text(start),
                                 to_text(end)));
  }
  return wanted;
}

void write(const CorrectArguments& a, const Correction& done) {
  if (a.format != Format::g2o) {
    TrajectoryFile file{done.output};
    if (!done.report.covariances.empty()) {
      for (const StampedPose& pose : done.output) {
        file.covariances.push_back(
            covariance_at(done.keyframes, done.report.covariances, pose.stamp));
      }
    }
    if (a.format != Format::tum) return write_trajectory(a.out, file, a.format);
    return write_tum(a.out, file, {"corrected by loopbench: " + done.method});
  }
  const bool has_anchors = !done.problem.anchors.empty();
  if (has_anchors && !is_graph(a)) {
    throw InputError(a.out + ": a g2o graph contains no anchors, expected another format");
  }
  if (a.dense || !a.at.empty()) {
    throw InputError(a.out + ": a graph contains the keyframes, expected no --dense and no --at");
  }
  PoseGraph graph = problem_graph(done.problem, done.keyframes, done.problem.ids);
  std::erase_if(graph.edges, [&](const Edge& edge) {
    return std::ranges::any_of(done.provenance.held, [&](const Edge& held) {
      return edge.from == held.from && edge.to == held.to &&
             edge.information.isApprox(held.information);
    });
  });
  graph.fixed = done.provenance.fixed;
  const InformationRules any{.indefinite = IndefiniteInformation::project};
  graph.planar =  // the lines of the input
      graph.planar && is_graph(a) && read_g2o(a.estimate, any).planar;
  TextWriter out = g2o_text(graph);
  if (has_anchors) {
    for (const std::string& line : prior_lines(a.estimate, graph, done.problem.anchors)) {
      out.word(line).end_line();
    }
  }
  out.save(a.out);
}

/// Moves the result so that the first vertex of FIX lines keeps its pose; methods hold keyframe 0.
void hold_first_fixed(Correction& done) {
  const std::vector<std::size_t>& fixed = done.provenance.fixed;
  if (fixed.empty() || fixed.front() == 0 || !done.problem.anchors.empty()) return;
  const Pose& before = done.problem.keyframes[fixed.front()].world_from_body;
  const Pose motion = before * done.keyframes[fixed.front()].world_from_body.inverse();
  for (Trajectory* const poses : {&done.keyframes, &done.output}) {
    for (auto& [stamp, pose] : *poses) pose = normalized(motion * pose);
  }
}

/// Writes the ledger of all closures.
void write_ledger(const CorrectArguments& a, Correction& done) {
  std::string rows;
  try {
    rows = csv(loops(done.problem, a.estimate));
  } catch (const std::runtime_error& error) {  // no ledger, or the joint solution fails
    done.report.notes.push_back(fmt::format("{} is not written: {}", a.ledger, error.what()));
  }
  if (!rows.empty()) write_file(a.ledger, rows);
}

bool has_stage(const MethodChoice& choice, const std::string& name) {
  return std::ranges::any_of(choice.stages, [&](const Choice& each) { return each.name == name; });
}

/// The catalogue whose consensus uses this judgement, if any, and leaves it to the sentence of the
/// check to state why closures do not decide.
Catalogue with_judgement(Catalogue catalogue,
                         const std::shared_ptr<const methods::ClosureJudgement>& known) {
  for (methods::MethodEntry& entry : catalogue.methods) {
    if (entry.name != kConsensus) continue;
    entry.make = [known](const Params& given) -> methods::Stage {
      return std::unique_ptr<const methods::Corrector>(std::make_unique<methods::Consensus>(
          with(methods::Consensus::Options{}, given), known, false));
    };
  }
  return catalogue;
}

/// The method that is wanted, or the default for closures with this check.
std::string method_name(const CorrectArguments& a,
                        const Problem& problem,
                        const std::optional<ClosureCheck>& check) {
  if (!a.method.empty()) return a.method;
  const bool is_judged = check ? check->judgement != nullptr : !problem.anchors.empty();
  const bool declines = !methods::Consensus({}).why_declined(problem).empty();
  return is_judged && !declines && !a.trusts_loops ? kConsensus : "pose_graph";
}

/// Sets the option `gravity` of the stages that have it. Throws InputError if none has.
void hold_gravity(MethodChoice& choice, const Catalogue& catalogue) {
  bool has_effect = false;
  for (Choice& stage : choice.stages) {
    if (is_program(stage)) continue;
    const std::vector<OptionInfo>& options = find_method(catalogue, stage.name).options;
    if (std::ranges::find(options, "gravity", &OptionInfo::name) == options.end()) continue;
    stage.options["gravity"] = has_effect = true;
  }
  if (!has_effect) {
    throw InputError("--gravity has no effect on " + choice.label +
                     ", expected consensus or pose_graph");
  }
  choice.label += " (gravity=true)";
}

/// correct(); a method that fails on the input is an InputError.
Correction corrected(Problem problem,
                     const std::string& name,
                     const MethodChoice& choice,
                     const std::vector<double>& at,
                     const Catalogue& catalogue,
                     const ClosureCheck* check) {
  try {
    return correct(std::move(problem), name, choice, at, catalogue, check);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(name + ": " + choice.label + " failed: " + error.what());
  }
}

}  // namespace

Problem load_problem(const CorrectArguments& a,
                     const Catalogue& catalogue,
                     Provenance* provenance) {
  const bool graph = is_graph(a);
  if (graph && !(a.loops.empty() && a.frames.empty() && a.anchors.empty())) {
    throw InputError(a.estimate +
                     ": is a g2o graph, which contains its closures and has no stamps and no "
                     "frames, expected no --loops, no --anchors and no --frames");
  }
  const DatasetEntry& dataset = find_dataset(catalogue, graph ? "pose_graph" : "trajectory");
  Params options = parse_settings(a.settings, dataset.options);
  options[graph ? "path" : "estimate"] = a.estimate;
  if (!a.frames.empty()) options["frames"] = a.frames;
  if (!a.anchors.empty()) options["anchors.file"] = a.anchors;
  if (!a.loops.empty()) {
    options["closures.file"] = a.loops;
    options["closures.source"] = "file";
  }
  dataset.check(options);
  Sequence loaded = dataset.load(options, DataRoot{{"."}});
  Problem& out = loaded.problem;
  if (a.start_equals_end) {
    if (out.keyframes.size() < 3) throw InputError(a.estimate + ": has fewer than 3 keyframes");
    out.closures.push_back(start_equals_end(out.keyframes, *a.start_equals_end));
    sort_closures(out.closures);
  }
  check(out, a.estimate);
  if (provenance != nullptr) *provenance = std::move(loaded.provenance);
  return std::move(out);
}

FigureData before_and_after(const Correction& done) {
  FigureData out{std::filesystem::path(done.estimate).filename().string(),
                 done.method,
                 {{.name = "before"}, {.name = "after", .style = 1}},
                 {},
                 {}};
  const Trajectory* const poses[] = {&done.problem.keyframes, &done.keyframes};
  for (std::size_t i = 0; i < out.curves.size(); ++i) {
    add_poses(out.curves[i], *poses[i], 0.0);
  }
  return out;
}

Correction correct(const CorrectArguments& a, const Catalogue& catalogue) {
  std::optional<MethodChoice> given;  // an unknown one is an error before the data are read
  if (!a.method.empty()) given = method_without_reference(a.method, catalogue);
  if (given && a.gravity) hold_gravity(*given, catalogue);
  Provenance provenance;
  Problem problem = load_problem(a, catalogue, &provenance);
  std::optional<ClosureCheck> check;
  const auto begin = std::chrono::steady_clock::now();
  const bool is_checked = !given || uses_closures(*given, catalogue);
  if (is_checked && !problem.closures.empty()) check = check_closures(problem);
  const std::chrono::duration<double> checked = std::chrono::steady_clock::now() - begin;
  MethodChoice choice =
      given ? *given : method_without_reference(method_name(a, problem, check), catalogue);
  if (!given && a.gravity) hold_gravity(choice, catalogue);
  const bool has_measurements = !problem.closures.empty() || !problem.anchors.empty();
  if (!has_measurements && !is_graph(a) && uses_closures(choice, catalogue)) {
    throw InputError(a.estimate + ": " + choice.label +
                     " declines: the problem has no loop closures, expected --loops FILE");
  }
  std::size_t outside = 0;
  const std::vector<double> at = output_stamps(a, problem, outside);
  const bool is_consensus = check && check->judgement && has_stage(choice, kConsensus);
  const bool is_replay = has_stage(choice, "online");  // consensus judges other problems, too
  const Catalogue used =
      is_consensus ? with_judgement(catalogue, is_replay ? nullptr : check->judgement) : catalogue;
  Correction out =
      corrected(std::move(problem), a.estimate, choice, at, used, check ? &*check : nullptr);
  out.outside = outside;
  out.provenance = std::move(provenance);
  out.check = std::move(check);
  out.is_consensus = is_consensus;
  if (is_consensus && !is_replay) {
    out.seconds += checked.count();
    out.report.phases.insert(out.report.phases.begin(), {"judge", checked.count()});
  }
  if (!a.ledger.empty()) write_ledger(a, out);
  const Rotation body_from_file = out.provenance.file_body_from_body.rotation.conjugate();
  change_body(out.problem, body_from_file);
  for (Trajectory* const poses : {&out.keyframes, &out.output}) change_body(*poses, body_from_file);
  hold_first_fixed(out);
  const std::vector<std::string>& notes = out.provenance.notes;
  out.report.notes.insert(out.report.notes.begin(), notes.begin(), notes.end());
  const bool loses_stamps = a.format == Format::kitti || a.format == Format::g2o;
  if (!a.out.empty()) write(a, out);
  if (!a.out.empty() && loses_stamps && !is_graph(a)) {
    out.report.notes.push_back(to_text(a.format) + " does not contain stamps");
  }
  out.out = a.out;
  return out;
}

}  // namespace loopbench::harness
