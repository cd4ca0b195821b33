#include "harness/run/run_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "methods/pipeline.hpp"

namespace loopbench {
namespace {

using Clock = std::chrono::steady_clock;

/// Runs `work`; an exception of any kind becomes a failed status with its text.
template <class Result, class Work>
void fenced(Result& result, Work work) {
  try {
    work();
  } catch (const std::exception& error) {
    result.status = Status::failed;
    result.why = error.what();
  } catch (...) {
    result.status = Status::failed;
    result.why = "threw something that is not a std::exception";
  }
}

/// Why so little was judged that the numbers do not stand beside others; empty when enough was.
std::string why_incomplete(const Coverage& coverage, double min_coverage) {
  if (std::min(coverage.share(), coverage.span) >= min_coverage) return "";
  return fmt::format("judged {} of {} poses over {:.1f} % of the reference's time, below {:.1f} %",
                     coverage.pairs,
                     coverage.possible,
                     100.0 * coverage.span,
                     100.0 * min_coverage);
}

/// All scores of one metric, or one row that says why there are none. `row` says what of.
void score(CellResult& result,
           const MetricChoice& choice,
           ScoreResult row,
           const Evaluation& evaluation,
           const Catalogue& catalogue) {
  row.metric = choice.label;
  row.coverage = evaluation.coverage;
  fenced(row, [&] {
    const MetricEntry& metric = find_metric(catalogue, choice.metric.name);
    for (Score& score : metric.score(evaluation, choice.metric.options)) {
      result.scores.push_back(row);
      ScoreResult& added = result.scores.back();
      if (!score.why_undefined.empty()) {
        added.status = Status::declined;
        added.why = score.why_undefined;
      }
      added.score = std::move(score);
    }
  });
  if (row.status == Status::failed) result.scores.push_back(row);
}

/// Every metric under one protocol at one choice of times, which `row` names.
void judge(CellResult& result,
           const ScoreResult& row,
           const Sweep& sweep,
           const Sequence& sequence,
           const Curve& curve,
           const Catalogue& catalogue) {
  const std::vector<double> keyframe_stamps = stamps(sequence.problem.keyframes);
  const Trajectory at_keyframes = curve.sample(keyframe_stamps);
  const Protocol& protocol = sweep.protocols[row.protocol].rules;
  ScoreResult none = row;
  fenced(none, [&] {
    Evaluation evaluation =
        evaluate(sequence.reference, curve, keyframe_stamps, row.times, protocol);
    evaluation.context = {&sequence.reference,
                          &at_keyframes,
                          &sequence.problem,
                          &curve,
                          row.times,
                          protocol,
                          &sequence.loop_candidates};
    ScoreResult usual = row;
    usual.why = why_incomplete(evaluation.coverage, sweep.min_coverage);
    if (!usual.why.empty()) {
      usual.status = Status::incomplete;
      result.status = Status::incomplete;
      result.why = to_text(row.times) + ": " + usual.why;
    }
    for (const MetricChoice& choice : sweep.metrics) {
      score(result, choice, usual, evaluation, catalogue);
    }
  });
  if (none.status == Status::ok) return;
  for (const MetricChoice& choice : sweep.metrics) {  // nothing matched, or no unique alignment
    none.metric = choice.label;
    result.scores.push_back(none);
  }
}

}  // namespace

std::unique_ptr<const Method> make_method(const MethodChoice& choice, const Catalogue& catalogue) {
  std::unique_ptr<const Corrector> corrector;
  std::unique_ptr<const Smoother> smoother;
  for (const Choice& part : choice.stages) {
    Stage stage = find_method(catalogue, part.name).make(part.options);
    if (auto* whole = std::get_if<std::unique_ptr<const Method>>(&stage)) return std::move(*whole);
    if (auto* first = std::get_if<std::unique_ptr<const Corrector>>(&stage)) {
      corrector = std::move(*first);
    } else {
      smoother = std::move(std::get<std::unique_ptr<const Smoother>>(stage));
    }
  }
  return compose(std::move(corrector), std::move(smoother));
}

CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue) {
  CellResult result;
  result.cell = cell;
  result.closures = sequence.provenance.closures;
  result.oracle_closures = sequence.provenance.oracle_closures;
  fenced(result, [&] {
    const auto method = make_method(sweep.methods[cell.method], catalogue);
    if (auto why = method->declines(sequence.problem)) {
      result.status = Status::declined;
      result.why = std::move(*why);
      return;
    }
    std::unique_ptr<const Curve> curve;
    for (int run = 0; run < sweep.timing; ++run) {
      Report report;
      const auto begin = Clock::now();
      curve = method->estimate(sequence.problem, report);
      const std::chrono::duration<double> took = Clock::now() - begin;
      result.seconds.push_back(took.count());
      result.report = std::move(report);
    }
    if (sequence.reference.empty()) {
      result.why = "no reference to judge against";
      return;
    }
    for (std::size_t p = 0; p < sweep.protocols.size(); ++p) {
      for (const Times times : sweep.times) {
        const ScoreResult row{p, times, "", {}, {}, Status::ok, ""};
        judge(result, row, sweep, sequence, *curve, catalogue);
      }
    }
  });
  return result;
}

}  // namespace loopbench
