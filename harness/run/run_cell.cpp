#include "harness/run/run_cell.hpp"

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
      row.score = std::move(score);
      result.scores.push_back(row);
    }
  });
  if (row.status != Status::ok) result.scores.push_back(row);
}

/// Every metric under one protocol at one choice of times, which `row` names.
void judge(CellResult& result,
           const ScoreResult& row,
           const Sweep& sweep,
           const Sequence& sequence,
           const Curve& curve,
           const Catalogue& catalogue) {
  ScoreResult none = row;
  fenced(none, [&] {
    const Evaluation evaluation = evaluate(sequence.reference,
                                           curve,
                                           stamps(sequence.problem.keyframes),
                                           row.times,
                                           sweep.protocols[row.protocol].rules);
    for (const MetricChoice& choice : sweep.metrics) {
      score(result, choice, row, evaluation, catalogue);
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
