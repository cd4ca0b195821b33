#include "harness/model/cell_records.hpp"

#include <limits>

#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// The fields that all records of a cell have in common.
Record record_of_cell(const CellResult& result, const Sweep& sweep) {
  Record out;
  out.cell = static_cast<std::int64_t>(result.cell.index);
  out.sequence = sweep.datasets[result.cell.dataset].label;
  out.repeat = result.cell.repeat;
  out.method = sweep.methods[result.cell.method].label;
  out.oracle = result.oracle_method;
  out.milliseconds = result.seconds.empty() ? std::numeric_limits<double>::quiet_NaN()
                                            : 1e3 * metrics::median(result.seconds);
  out.is_stated = result.worker.stated;
  out.status = result.status;
  out.why = result.why;
  if (result.metadata) {
    out.closures = result.metadata->closures;
    out.oracle_closures = result.metadata->oracle_closures;
    out.group = result.metadata->group;
    out.content = result.metadata->content;
  }
  return out;
}

}  // namespace

std::vector<Record> records_of(const CellResult& result, const Sweep& sweep) {
  const Record cell = record_of_cell(result, sweep);
  if (result.scores.empty()) return {cell};
  std::vector<Record> out;
  for (const ScoreResult& score : result.scores) {
    Record& r = out.emplace_back(cell);
    r.protocol = sweep.protocols[score.protocol].label();
    r.protocol_version = sweep.protocols[score.protocol].version;
    r.times = to_text(score.times);
    r.metric = score.metric;
    r.label = score.label;
    r.relation = score.score.relation;
    r.axis = score.score.axis;
    r.unit = score.score.unit;
    r.better = score.score.better;
    r.target = score.score.target;
    r.statistics = score.score.statistics;
    r.pairs = static_cast<std::int64_t>(score.coverage.pairs);
    r.possible = static_cast<std::int64_t>(score.coverage.possible);
    r.span = score.coverage.span;
    r.status = score.status;
    r.why = score.why;
  }
  return out;
}

}  // namespace loopbench::harness
