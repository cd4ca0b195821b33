#include "harness/commands/eval/evaluated_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/text_file.hpp"
#include "harness/commands/eval/evaluated_file.hpp"
#include "harness/commands/files/trajectory_selection.hpp"
#include "harness/sweep/text/counted.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {
namespace {

using metrics::RowRange;

/// Rows of the poses between two stamps.
RowRange rows_between(const Trajectory& poses, double first, double last) {
  const std::vector<std::size_t> rows = within(poses, first, last);
  return rows.empty() ? RowRange{} : RowRange{rows.front(), rows.back() + 1};
}

std::vector<std::size_t> indices_of(const RowRange& rows) {
  std::vector<std::size_t> out(rows.end - rows.begin);
  std::iota(out.begin(), out.end(), rows.begin);
  return out;
}

std::vector<RowRange> parts_of_file(const std::string& name, const Trajectory& poses) {
  TextFile file(name);
  std::vector<std::pair<double, double>> ranges;
  std::vector<std::size_t> lines;
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    const double first = columns.number("first stamp");
    const double last =
        columns.done() ? std::numeric_limits<double>::quiet_NaN() : columns.number("last stamp");
    if (!columns.done()) {
      throw file.error(line.number, "expected the first stamp of a part, or its first and last");
    }
    if (!ranges.empty() && !(first > ranges.back().first)) {
      throw file.error(line.number,
                       fmt::format("the part begins at {:g} s, the one before it at {:g} s; "
                                   "expected parts in the order of time",
                                   first,
                                   ranges.back().first));
    }
    ranges.emplace_back(first, last);
    lines.push_back(line.number);
  }
  if (ranges.empty()) throw file.error(0, "has no parts, expected one per line");
  std::vector<RowRange> out;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    auto [first, last] = ranges[i];
    if (std::isnan(last)) {
      const bool is_last = i + 1 == ranges.size();
      last = is_last ? poses.back().stamp
                     : std::nextafter(ranges[i + 1].first, -std::numeric_limits<double>::max());
    }
    const RowRange rows = rows_between(poses, first, last);
    if (rows.begin == rows.end) {
      throw file.error(lines[i], fmt::format("part {} has no poses of the estimate", i + 1));
    }
    if (!out.empty() && rows.begin < out.back().end) {
      throw file.error(lines[i],
                       fmt::format("the part begins with row {} of the estimate, which is also in "
                                   "the part before it; expected parts without common poses",
                                   rows.begin));
    }
    out.push_back(rows);
  }
  return out;
}

/// Statistics of the errors of all parts; NaN for those that do not follow from the parts'.
metrics::Statistics pooled(const std::vector<metrics::Statistics>& parts, int ddof) {
  metrics::Statistics out;
  out.min = std::numeric_limits<double>::infinity();
  for (const metrics::Statistics& part : parts) {
    out.count += part.count;
    out.mean += static_cast<double>(part.count) * part.mean;
    out.sse += part.sse;
    out.min = std::min(out.min, part.min);
    out.max = std::max(out.max, part.max);
  }
  const auto count = static_cast<double>(out.count);
  out.mean /= count;
  out.rmse = std::sqrt(out.sse / count);
  const double squares = std::max(0.0, out.sse - count * out.mean * out.mean);
  out.std = count > ddof ? std::sqrt(squares / (count - ddof)) : 0.0;
  for (double metrics::Statistics::*member : {&metrics::Statistics::median,
                                              &metrics::Statistics::p90,
                                              &metrics::Statistics::p95,
                                              &metrics::Statistics::p99}) {
    out.*member = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

bool are_alike(const Record& a, const Record& b) {
  return a.kind->metric == b.kind->metric && a.kind->label == b.kind->label &&
         a.kind->relation == b.kind->relation && a.kind->axis == b.kind->axis;
}

/// One result over those of the parts under one protocol, of which at least one is evaluated.
EvaluationResult over_parts(const std::vector<EvaluationResult>& parts,
                            const std::string& name,
                            std::size_t poses) {
  const auto first = std::ranges::find_if(
      parts, [](const EvaluationResult& part) { return part.why_failed.empty(); });
  EvaluationResult out;
  out.reference = parts.front().reference;
  out.reference_body = parts.front().reference_body;
  out.protocol = parts.front().protocol;
  out.estimate = name;
  out.estimate_poses = poses;
  if (first == parts.end()) {
    out.why_failed = parts.front().why_failed;
    return out;
  }
  out.reference_poses = first->reference_poses;
  out.alignment.type = first->alignment.type;
  out.coverage.possible = poses;
  out.coverage.span = 0.0;
  for (const EvaluationResult& part : parts) {
    if (!part.why_failed.empty()) continue;
    out.coverage.pairs += part.coverage.pairs;
    out.coverage.span += part.coverage.span;
    out.coverage.bridged += part.coverage.bridged;
    for (const Record& record : part.records) {
      const auto is_known = [&](const Record& known) { return are_alike(known, record); };
      if (std::ranges::none_of(out.records, is_known)) out.records.push_back(record);
    }
  }
  out.coverage.span = std::min(1.0, out.coverage.span);
  for (Record& record : out.records) {
    std::vector<metrics::Statistics> own;
    for (const EvaluationResult& part : parts) {
      for (const Record& each : part.records) {
        if (are_alike(each, record) && has_numbers(each.status)) own.push_back(each.statistics);
      }
    }
    if (own.empty()) continue;
    record.status = Status::ok;
    record.why = {};
    record.statistics = pooled(own, out.protocol.rules.ddof);
  }
  return out;
}

/// The evaluation of one part under all protocols; those that fail have a reason.
Evaluations evaluated_part(const EvalArguments& a,
                           const EvaluatedFile& reference,
                           const EvaluatedFile& part) {
  try {
    return evaluate_in_memory(a, reference, part);
  } catch (const InputError& error) {
    Evaluations out;
    for (const metrics::NamedProtocol& protocol : protocols(a)) {
      EvaluationResult& own = out.results.emplace_back();
      own.protocol = protocol;
      own.why_failed = error.what();
    }
    return out;
  }
}

void add_estimate(const EvalArguments& a, const std::string& name, Evaluations& out) {
  const EvaluatedFile reference = evaluated_reference(a.reference, a, false, name);
  const EvaluatedFile estimate = evaluated_estimate(name, a, false, &reference);
  const std::vector<metrics::NamedProtocol> rules = protocols(a);
  const std::vector<RowRange> parts =
      parts_of(a.parts, reference.poses, estimate.poses, rules.front().rules.offset);
  EvalArguments own = a;
  own.diagnose = false;
  own.min_coverage = 0.0;
  own.keeps_failed = true;
  std::vector<std::vector<EvaluationResult>> by_protocol(rules.size());
  for (const RowRange& rows : parts) {
    EvaluatedFile part = estimate;
    keep_poses(part, indices_of(rows));
    Evaluations found = evaluated_part(own, reference, part);
    const std::string label = fmt::format("{} rows {}-{}", name, rows.begin, rows.end - 1);
    for (std::size_t k = 0; k < found.results.size(); ++k) {
      EvaluationResult& result = found.results[k];
      result.reference = a.reference;
      result.estimate = label;
      result.reference_body = a.reference_body.value_or("");
      by_protocol[k].push_back(std::move(result));
    }
  }
  for (std::vector<EvaluationResult>& all : by_protocol) {
    const std::string label = fmt::format("{} ({})", name, counted(parts.size(), "part"));
    all.push_back(over_parts(all, label, estimate.poses.size()));
    const EvaluationResult& last = all.back();
    const double least = a.min_coverage.value_or(0.1);
    if (last.why_failed.empty() && last.coverage.least() < least) {
      all.back().incomplete_reason =
          fmt::format("evaluated {} of {} poses", last.coverage.pairs, last.coverage.possible);
    }
    std::ranges::move(all, std::back_inserter(out.results));
  }
}

}  // namespace

std::vector<RowRange> parts_of(const std::string& rule,
                               const Trajectory& reference,
                               const Trajectory& poses,
                               double offset) {
  return rule == "auto" ? metrics::map_parts(reference, poses, offset) : parts_of_file(rule, poses);
}

std::vector<NamedTrajectory> split_file(const NamedTrajectory& file,
                                        const std::string& rule,
                                        const Trajectory& reference,
                                        double offset) {
  std::vector<NamedTrajectory> out;
  for (const RowRange& rows : parts_of(rule, reference, file.file.poses, offset)) {
    const std::string name = fmt::format("{}_part{}.txt", plain_stem(file.name), out.size() + 1);
    out.push_back({name, selected(file.file, indices_of(rows)), {}});
  }
  return out;
}

Evaluations evaluate_parts(const EvalArguments& a) {
  if (!a.store.empty() || !a.report.empty() || !a.plot.empty()) {
    throw InputError("--parts: write the parts with `traj split` for --store, --report or --plot");
  }
  check_estimates(a);
  Evaluations out;
  for (const std::string& name : a.estimates) add_estimate(a, name, out);
  for (EvaluationResult& result : out.results) {
    for (Record& record : result.records) {
      record.cell.edit().sequence = a.reference;
      record.cell.edit().method = result.estimate;
    }
    if (!a.unit.empty()) change_unit(result.records, a.unit);
    std::ranges::copy(result.records, std::back_inserter(out.records));
  }
  return out;
}

}  // namespace loopbench::harness
