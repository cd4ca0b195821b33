#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "datasets/core/closure_places.hpp"
#include "harness/commands/correct/correct.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/config/choices.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/evaluation_notes.hpp"
#include "metrics/correction/graph_cost.hpp"

namespace loopbench::harness {
namespace {

/// Writes to `why` the reason if there are none.
std::optional<std::vector<Residual>> residuals(const Problem& problem,
                                               const Trajectory& keyframes,
                                               std::string& why) {
  metrics::Evaluation evaluation;
  evaluation.context.problem = &problem;
  evaluation.context.estimate = &keyframes;
  metrics::Statistics metres, degrees;  // zero without closures
  try {
    if (!problem.closures.empty()) {
      const std::vector<metrics::Score> scores = metrics::closure_residual(evaluation);
      metres = scores.at(0).statistics;
      degrees = scores.at(1).statistics;
    }
    const std::vector<metrics::Score> cost = metrics::graph_cost(evaluation, {});
    std::vector<Residual> out{{"translation_rms", "closure residual, rms [m]", metres.rmse},
                              {"translation_max", "closure residual, max [m]", metres.max},
                              {"rotation_rms", "closure residual, rms [deg]", degrees.rmse},
                              {"rotation_max", "closure residual, max [deg]", degrees.max},
                              {"chi2_odometry", "chi2 of odometry", cost.at(1).statistics.rmse},
                              {"chi2_closures", "chi2 of closures", cost.at(2).statistics.rmse}};
    if (problem.anchors.empty()) return out;
    double sum = 0.0, max = 0.0;
    for (const Anchor& anchor : problem.anchors) {
      const double e = anchor_error(anchor, keyframes[anchor.keyframe].world_from_body).norm();
      sum += e * e;
      max = std::max(max, e);
    }
    const double rms = std::sqrt(sum / static_cast<double>(problem.anchors.size()));
    out.push_back({"anchor_rms", "anchor error, rms [m]", rms});
    out.push_back({"anchor_max", "anchor error, max [m]", max});
    return out;
  } catch (const metrics::Undefined&) {
    why = "an edge changes the scale";
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  return std::nullopt;
}

/// Anchors that a method dropped are in the residuals, too: their titles state it.
void name_all_anchors(const Correction& done, std::optional<std::vector<Residual>>& residuals) {
  const auto all = static_cast<double>(done.problem.anchors.size());
  const bool are_dropped = std::ranges::any_of(done.report.counts, [&](const methods::Count& each) {
    return each.name == "anchors_kept" && each.value < all;
  });
  if (!are_dropped || !residuals) return;
  for (Residual& each : *residuals) {
    if (std::string_view(each.key) == "anchor_rms") each.title = "all anchors, rms [m]";
    if (std::string_view(each.key) == "anchor_max") each.title = "all anchors, max [m]";
  }
}

std::optional<std::size_t> rejected_closures(const Correction& done) {
  if (done.report.rejected) return done.report.rejected->size();
  for (const methods::Count& count : done.report.counts) {
    if (count.name == "closures_kept" || count.name == "closures_consistent") {
      return done.problem.closures.size() - static_cast<std::size_t>(count.value);
    }
  }
  return std::nullopt;
}

/// Notes on the closures that were kept; of a check, on all closures, without what it states.
std::vector<Note> notes_of_closures(const Problem& all,
                                    const Problem& kept,
                                    const ClosureCheck* check) {
  if (check == nullptr || check->judgement == nullptr) return closure_notes(kept);
  std::vector<Note> out = closure_notes(all, check->judgement.get());
  std::erase_if(out, [](const Note& note) {
    return note.kind == NoteKind::closure_gap || note.kind == NoteKind::odometry_step ||
           note.kind == NoteKind::information;
  });
  return out;
}

}  // namespace

MethodChoice method_without_reference(const std::string& text, const Catalogue& catalogue) {
  MethodChoice out = method_choices(parse_entry(text, "--method"), catalogue).front();
  for (const Choice& stage : out.stages) {
    if (is_oracle(catalogue, stage.name)) {
      throw InputError("--method: " + stage.name + " reads the reference, which is not given here");
    }
  }
  return out;
}

Correction correct(Problem problem,
                   const std::string& name,
                   const MethodChoice& choice,
                   const std::vector<double>& at,
                   const Catalogue& catalogue,
                   const ClosureCheck* closure_check) {
  const auto method = make_method(choice, catalogue, {});
  if (const std::string why = methods::reason_to_decline(*method, problem); !why.empty()) {
    throw InputError(name + ": " + choice.label + " declines: " + why);
  }
  Correction out;
  out.problem = std::move(problem);
  out.estimate = name;
  out.method = choice.label;
  program_costs() = {};
  const auto begin = std::chrono::steady_clock::now();
  const std::unique_ptr<const Curve> curve = method->estimate(out.problem, out.report);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  settle_costs(out.report);
  out.keyframes = curve->sample(stamps(out.problem.keyframes));
  check(out.keyframes, choice.label);
  check_covariances(out.report.covariances, out.keyframes.size());
  check_rejected(out.report.rejected, out.problem.closures.size());
  out.output = curve->sample(at);
  check(out.output, choice.label);
  const std::vector<std::size_t> rejected =
      out.report.rejected.value_or(std::vector<std::size_t>{});
  // Of a method that rejects all, the residuals of all show what is left.
  const bool keeps_some = rejected.size() < out.problem.closures.size();
  const Problem kept = keeps_some ? without_closures(out.problem, rejected) : out.problem;
  out.before = residuals(kept, out.problem.keyframes, out.why_no_residuals);
  out.after = residuals(kept, out.keyframes, out.why_no_residuals);
  for (auto* const residuals : {&out.before, &out.after}) name_all_anchors(out, *residuals);
  out.rejected = rejected_closures(out);
  std::erase_if(out.report.counts, [](const methods::Count& c) {  // of the solver's start
    return c.name == "chi2_before" || c.name == "robust_chi2_before";
  });
  for (const Note& note : notes_of_closures(out.problem, kept, closure_check)) {
    out.report.notes.push_back(text(note));
  }
  return out;
}

}  // namespace loopbench::harness
