#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "harness/answers/tables/pivot.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/commands/eval/evaluation_result.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMargin = 11;  ///< of the values beside their names
constexpr std::size_t kWidth = 100;  ///< of long lists without a terminal

std::string protocol_text(const metrics::NamedProtocol& protocol) {
  return fmt::format("{} [{}]", protocol.label(), protocol.version);
}

/// `text` beside `name`, in lines of at most `columns`; 0: any.
std::string property(const std::string& name, const std::string& text, std::size_t columns) {
  if (text.empty()) return "";
  std::string out = padded(name, kMargin, true);
  std::size_t count = 0;
  for (const std::string& line : wrapped(text, columns == 0 ? 0 : columns - kMargin)) {
    out += (count++ == 0 ? "" : std::string(kMargin, ' ')) + line + "\n";
  }
  return out;
}

/// "x,y,z,qx,qy,qz,qw = 1,2,3,0,0,0,1" as `traj transform --left` reads it; empty if not aligned.
std::string transform_text(const metrics::Alignment& alignment) {
  if (alignment.type == metrics::Align::none) return "";
  const auto& [rotation, position] = alignment.reference_from_estimate;
  return fmt::format("x,y,z,qx,qy,qz,qw = {:.6g}, {:.6g}",
                     fmt::join(position, ", "),
                     fmt::join(rotation.coeffs(), ", "));
}

std::string path_text(const std::string& path, const std::string& rest, std::size_t columns) {
  if (columns == 0) return path + rest;
  return shortened(path, columns - std::min(columns, kMargin + rest.size())) + rest;
}

/// "largest_gap 0.25 s, repeated 0, ...".
std::string diagnosis_text(const std::vector<metrics::Score>& diagnosis) {
  std::string out;
  for (const metrics::Score& score : diagnosis) {
    out +=
        fmt::format("{}{} {:.4g}", out.empty() ? "" : ", ", score.relation, score.statistics.mean);
    if (score.unit != "1") out += " " + score.unit;
  }
  return out;
}

bool is_total(const Record& record) {
  return record.kind->axis == "3d" || record.kind->axis == "all";
}

/// "rpe 1 s x [m]", without the unit if there is none.
std::string score_name(const Record& record) {
  ScoreKind kind = *record.kind;
  if (kind.is_total()) kind.axis = "3d";  // not stated
  return kind.unit.empty() ? kind.short_name() : kind.short_name() + " [" + kind.unit + "]";
}

/// Undefined scores and failed metrics, as notes of `row`.
std::vector<Missing> missing_scores(const EvaluationResult& result, const std::string& row) {
  std::vector<Missing> out;
  for (const Record& record : result.records) {
    if (has_numbers(record.status)) continue;
    const std::string status = is_failure(record.status) ? "failed" : "undefined";
    out.push_back({row, score_name(record), status, record.why});
  }
  return out;
}

/// `digits`: decimals; none: four significant digits.
Table scores_view(const EvaluationResult& result, std::optional<int> digits) {
  std::vector<metrics::StatisticField> shown;
  Table out{"", {"score"}, {}, {}};
  for (const metrics::StatisticField& each : metrics::kStatisticFields) {
    if (each.share > 0.0 || !has_direction(each.name)) continue;
    shown.push_back(each);
    out.headings.emplace_back(each.name);
  }
  out.headings.emplace_back("count");
  for (const Record& record : result.records) {
    if (!has_numbers(record.status)) continue;
    const metrics::Statistics& s = record.statistics;
    std::vector<TableCell>& line = out.lines.emplace_back();
    line.push_back({score_name(record)});
    for (const metrics::StatisticField& each : shown) {
      line.push_back({fixed(s.*each.member, digits.value_or(decimals(s.rmse)))});
    }
    line.push_back({std::to_string(s.count)});
  }
  const std::vector<std::string> missing = grouped(missing_scores(result, ""));
  out.notes.assign(missing.begin(), missing.end());
  return out;
}

bool fits(const std::string& text, std::size_t columns) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (width(line) > columns) return false;
  }
  return true;
}

/// The coverage as a score, for tables.
Record coverage_record(const EvaluationResult& result) {
  Record out;
  out.kind.edit().metric = "coverage";
  out.kind.edit().axis = "3d";
  out.kind.edit().relation = "translation";
  out.kind.edit().unit = "%";
  out.kind.edit().protocol = result.protocol.label();
  out.statistics = metrics::single("coverage", "", "%", 100.0 * result.coverage.least()).statistics;
  return out;
}

/// Whether a summary shows the record: ATE, RPE over 1 s or random pairs, and the
/// segments of protocols that set their lengths.
bool is_in_summary(const Record& record, const metrics::Protocol& protocol) {
  const std::string& label = record.kind->metric_label();
  return record.kind->metric == "ate" || label == "rpe 1 s" || label == "rpe" ||
         (record.kind->metric == "segments" && protocol.segments != metrics::SegmentErrorRule{});
}

/// Rows of the comparison: the estimate is the method, and no score is ranked.
std::vector<Record> compared_records(const EvaluationResult& result,
                                     const std::string& name,
                                     Detail detail,
                                     bool has_totals) {
  std::vector<Record> out;
  for (const Record& record : result.records) {
    const bool is_shown = record.kind->relation.empty() || !has_totals || is_total(record);
    const bool is_wanted =
        detail != Detail::summary || is_in_summary(record, result.protocol.rules);
    if (is_shown && is_wanted) out.push_back(record);
  }
  out.push_back(coverage_record(result));
  if (!result.why_failed.empty()) {
    out.front() = {};
    out.front().status = Status::failed;
    out.front().why = result.why_failed;
    out.front().kind.edit().protocol = result.protocol.label();
  }
  for (Record& record : out) {
    record.cell.edit().sequence = result.reference;
    record.cell.edit().method = name;
    record.cell.edit().repeat = 0;
    record.cell.edit().content = "";
    record.cell.edit().group = "";
    record.kind.edit().better = metrics::Better::neither;
  }
  return out;
}

std::string body_text(const EvaluationResult& result) {
  return result.reference_body.empty() ? "" : ", body offset " + result.reference_body;
}

std::string estimate_name_of(const EvaluationResult* result) {
  return std::filesystem::path(result->estimate).filename().string();
}

/// Results under one protocol.
Table comparison_of(const std::vector<const EvaluationResult*>& results,
                    Detail detail,
                    bool has_totals) {
  std::vector<Record> records;
  std::vector<Missing> notes, above;
  for (const EvaluationResult* result : results) {
    const bool is_unique =
        std::ranges::count(results, estimate_name_of(result), estimate_name_of) == 1;
    const std::string name = is_unique ? estimate_name_of(result) : result->estimate;
    const std::vector<Record> own = compared_records(*result, name, detail, has_totals);
    records.insert(records.end(), own.begin(), own.end());
    if (!result->other_body.empty()) notes.push_back({name, "", "other body", result->other_body});
    for (const Note& note : result->notes) {
      const bool is_above = note.severity == Severity::decisive;
      (is_above ? above : notes).push_back({name, "", "note", text(note)});
    }
  }
  const EvaluationResult& first = *results.front();
  TableSpec spec;
  spec.split.clear();
  spec.value = to_text(first.protocol.rules.statistic);
  Table out = pivot(records, spec).front();
  out.headings[0] = "estimate";
  const bool is_aligned = first.protocol.rules.align != metrics::Align::none;
  out.title = fmt::format("{}, {} against {}{}{}",
                          protocol_text(first.protocol),
                          spec.value,
                          first.reference,
                          is_aligned ? "" : ", not aligned",
                          body_text(first));
  out.above = grouped(above);
  for (const std::string& note : grouped(notes)) out.notes.emplace_back(note);
  if (detail == Detail::all) {
    out.notes.push_back("other statistics: --set statistic=max, --csv, or one estimate at a time");
  }
  return out;
}

}  // namespace

std::string text(const EvaluationResult& result,
                 const std::optional<TerminalStyle>& style,
                 Detail detail) {
  const std::size_t columns = style ? std::max<std::size_t>(40, style->width) : 0;
  const auto line = [&](const char* name, const std::string& value) {
    return property(name, value, columns);
  };
  const auto poses = [](std::size_t count) { return " (" + counted(count, "pose") + ")"; };
  const metrics::Coverage& covered = result.coverage;
  std::string diagnosis;
  if (detail == Detail::all) {
    const std::size_t width = style ? std::min(columns, kWidth) : kWidth;
    diagnosis = property("diagnosis", diagnosis_text(result.diagnosis), width);
  }
  std::string out =
      line(
          "reference",
          path_text(result.reference, poses(result.reference_poses) + body_text(result), columns)) +
      line("estimate", path_text(result.estimate, poses(result.estimate_poses), columns)) +
      line("protocol", protocol_text(result.protocol)) +
      line("pairs",
           fmt::format("{} of {} ({:.1f} %), over {:.1f} % of the reference's time",
                       covered.pairs,
                       covered.possible,
                       100.0 * covered.share(),
                       100.0 * covered.span)) +
      line("incomplete", result.incomplete_reason) +
      line("alignment",
           fmt::format("{}, scale {}", to_text(result.alignment.type), result.alignment.scale)) +
      line("transform", transform_text(result.alignment)) + diagnosis +
      line("other body", result.other_body.empty() ? "" : result.other_body + "; see --ref-body");
  for (const Note& note : result.notes) out += line("note", text(note));
  if (detail == Detail::summary) {
    EvaluationResult row = result;
    std::erase_if(row.records, [&](const Record& record) {
      return !is_total(record) || !is_in_summary(record, result.protocol.rules);
    });
    for (Record& record : row.records) {
      if (has_numbers(record.status)) record.status = Status::ok;
    }
    Table summary = comparison({row}, detail).front();
    summary.title.clear();
    summary.above.clear();
    const std::vector<std::string> missing = grouped(missing_scores(row, ""));
    summary.notes.assign(missing.begin(), missing.end());
    return out + "\n" + terminal(summary, {style ? columns : 80, style && style->color});
  }
  const std::string scores = terminal(scores_view(result, 6));
  if (!style || fits(scores, columns)) return out + "\n" + scores;
  return out + "\n" + terminal(scores_view(result, std::nullopt), {columns, style->color});
}

std::vector<Table> comparison(const std::vector<EvaluationResult>& results, Detail detail) {
  const bool has_totals = std::ranges::any_of(results, [](const EvaluationResult& result) {
    return std::ranges::any_of(result.records, is_total);
  });
  std::vector<std::vector<const EvaluationResult*>> by_protocol;
  for (const EvaluationResult& result : results) {
    const std::string label = result.protocol.label();
    const auto same = std::ranges::find(
        by_protocol, label, [](const auto& group) { return group.front()->protocol.label(); });
    (same == by_protocol.end() ? by_protocol.emplace_back() : *same).push_back(&result);
  }
  std::vector<Table> out;
  for (const auto& own : by_protocol) out.push_back(comparison_of(own, detail, has_totals));
  return out;
}

}  // namespace loopbench::harness
