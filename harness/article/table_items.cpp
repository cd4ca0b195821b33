#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/article/ledger.hpp"
#include "harness/article/reported.hpp"

namespace loopbench::harness {
namespace {

const std::string kOrb = "ORB_SLAM2";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const ReportedRow& printed_row(int table, const std::string& variant) {
  return *std::ranges::find_if(reported_rows(), [&](const ReportedRow& row) {
    return row.table == table && row.variant == variant;
  });
}

/// Relative change of the ATE along an axis against the raw run; NaN without a result.
double change(const std::vector<PaperCell>& cells,
              const PaperCell& raw,
              const std::string& reading,
              const ReportedRow& row,
              metrics::Times times) {
  const PaperCell* ours = find_cell(cells, raw, reading, row.variant);
  const auto before = axis_numbers(raw, row.axis, times);
  const auto after = ours ? axis_numbers(*ours, row.axis, times) : std::nullopt;
  return before && after ? after->ate / before->ate - 1.0 : kNone;
}

std::string range_text(const std::vector<double>& changes, double printed) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::size_t same = 0, count = 0;
  for (const double c : changes) {
    if (!std::isfinite(c)) continue;
    ++count;
    low = std::min(low, c);
    high = std::max(high, c);
    if (std::abs(c) >= kTiedChange && (c < 0.0) == (printed < 0.0)) ++same;
  }
  if (count == 0) return "";
  return fmt::format("{} to {} in {} runs; printed sign in {}",
                     percent_change(low),
                     percent_change(high),
                     count,
                     same);
}

LedgerItem change_item(const std::vector<PaperCell>& cells, const ReportedRow& row) {
  using metrics::Times;
  const ReportedRow& base = printed_row(row.table, kOrb);
  const double printed = row.ate / base.ate - 1.0;
  LedgerItem item{fmt::format("Table {}, {}", row.table, row.variant),
                  fmt::format("{} ATE along {}: {} instead of {} m ({})",
                              row.sequence,
                              row.axis,
                              row.ate,
                              base.ate,
                              percent_change(printed)),
                  "no such run",
                  "",
                  Verdict::cannot_be_judged};
  const std::vector<const PaperCell*> runs = raw_runs(cells, row.sequence);
  if (runs.empty()) return item;
  const double at_keyframes = change(cells, *runs.front(), "text", row, Times::keyframes);
  if (!std::isfinite(at_keyframes)) return item;
  item.verdict = verdict_on_change(printed, at_keyframes);
  item.ours =
      fmt::format("text {} at keyframes, {} densely; equations {}, {}; guarded {}, {}",
                  percent_change(at_keyframes),
                  percent_change(change(cells, *runs.front(), "text", row, Times::dense)),
                  percent_change(change(cells, *runs.front(), "equations", row, Times::keyframes)),
                  percent_change(change(cells, *runs.front(), "equations", row, Times::dense)),
                  percent_change(change(cells, *runs.front(), "guarded", row, Times::keyframes)),
                  percent_change(change(cells, *runs.front(), "guarded", row, Times::dense)));
  std::vector<double> all;
  for (const PaperCell* raw : runs) {
    all.push_back(change(cells, *raw, "text", row, Times::keyframes));
  }
  item.runs = range_text(all, printed);
  return item;
}

LedgerItem level_item(const std::vector<PaperCell>& cells, const ReportedRow& row) {
  LedgerItem item{
      fmt::format("Table {}, {}", row.table, row.variant),
      fmt::format("{}: ORB-SLAM2's ATE along {} is {} m", row.sequence, row.axis, row.ate),
      "no such run",
      "",
      Verdict::cannot_be_judged};
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const std::vector<const PaperCell*> runs = raw_runs(cells, row.sequence);
  for (const PaperCell* raw : runs) {
    const auto numbers = axis_numbers(*raw, row.axis, metrics::Times::keyframes);
    if (!numbers) continue;
    low = std::min(low, numbers->ate);
    high = std::max(high, numbers->ate);
    if (raw != runs.front()) continue;
    item.ours = fmt::format(
        "{:.4f} m, printed {:.1f} times as large", numbers->ate, row.ate / numbers->ate);
    const double factor = row.ate / numbers->ate;
    item.verdict =
        std::max(factor, 1.0 / factor) <= kComparable ? Verdict::holds : Verdict::does_not_hold;
  }
  if (high >= low) item.runs = fmt::format("{:.4f} to {:.4f} m in {} runs", low, high, runs.size());
  return item;
}

/// "N = 4 fits best": the smallest ATE along one axis.
LedgerItem best_item(const std::vector<PaperCell>& cells,
                     const char* where,
                     const std::string& sequence,
                     const std::string& axis,
                     const std::string& expected,
                     const std::vector<std::string>& variants,
                     metrics::Times times) {
  LedgerItem item{where,
                  fmt::format("{}: {} fits best along {}", sequence, expected, axis),
                  "no such run",
                  "",
                  Verdict::cannot_be_judged};
  const std::vector<const PaperCell*> runs = raw_runs(cells, sequence);
  for (const char* reading : {"equations", "text"}) {
    std::size_t won = 0, judged = 0;
    for (const PaperCell* raw : runs) {
      double own = kNone;
      double other = std::numeric_limits<double>::infinity();
      std::string numbers;
      for (const std::string& variant : variants) {
        const PaperCell* cell = find_cell(cells, *raw, reading, variant);
        const auto found = cell ? axis_numbers(*cell, axis, times) : std::nullopt;
        if (!found) continue;
        numbers += fmt::format("{}{} {:.4f}", numbers.empty() ? "" : ", ", variant, found->ate);
        if (variant.starts_with(expected)) {
          own = std::isfinite(own) ? std::min(own, found->ate) : found->ate;
        } else {
          other = std::min(other, found->ate);
        }
      }
      if (!std::isfinite(own) || !std::isfinite(other)) continue;
      ++judged;
      const Verdict verdict = verdict_on_smallest(own, other);
      if (verdict == Verdict::holds) ++won;
      if (raw != runs.front()) continue;
      const bool first = item.verdict == Verdict::cannot_be_judged;
      item.ours = fmt::format("{}{} [m] {}: {}",
                              first ? "" : item.ours + "; ",
                              reading,
                              times == metrics::Times::dense ? "densely" : "at keyframes",
                              numbers);
      if (first) item.verdict = verdict;
    }
    if (judged == 0) continue;
    item.runs += fmt::format(
        "{}{} best in {} of {} runs", item.runs.empty() ? "" : ", ", reading, won, judged);
  }
  return item;
}

/// "Better in some areas": in how many printed rows the ATE is below ORB_SLAM2's, and in how many
/// of ours.
LedgerItem better_rows_item(const std::vector<PaperCell>& cells) {
  std::size_t rows = 0, printed = 0, judged = 0, ours = 0;
  for (const ReportedRow& row : reported_rows()) {
    if (row.variant == kOrb) continue;
    ++rows;
    if (row.ate < (1.0 - kTiedChange) * printed_row(row.table, kOrb).ate) ++printed;
    const std::vector<const PaperCell*> runs = raw_runs(cells, row.sequence);
    if (runs.empty()) continue;
    const double at_keyframes =
        change(cells, *runs.front(), "text", row, metrics::Times::keyframes);
    if (!std::isfinite(at_keyframes)) continue;
    ++judged;
    if (at_keyframes < -kTiedChange) ++ours;
  }
  return {"Tables 1 to 4",
          fmt::format("ATE below ORB_SLAM2's in {} of {} rows", printed, rows),
          fmt::format("text at keyframes: in {} of {} rows", ours, judged),
          "",
          judged == 0           ? Verdict::cannot_be_judged
          : 2 * ours >= printed ? Verdict::holds
          : ours > 0            ? Verdict::other_size
                                : Verdict::does_not_hold};
}

/// The text's best N or M against the printed rows of its table that are lower in mean and ATE.
LedgerItem text_against_table(int table, const std::string& best) {
  const ReportedRow& row = printed_row(table, best);
  std::string lower;
  for (const ReportedRow& other : reported_rows()) {
    if (other.table != table || other.variant == kOrb) continue;
    if (other.mean >= row.mean || other.ate >= row.ate) continue;
    lower += fmt::format("; {} has mean {}, ATE {}", other.variant, other.mean, other.ate);
  }
  return {fmt::format("Text and table {}", table),
          fmt::format("{}: {} fits the complete run best", row.sequence, best),
          fmt::format("its printed row has mean {}, ATE {}{}", row.mean, row.ate, lower),
          "",
          Verdict::contradicts_itself};
}

}  // namespace

std::vector<LedgerItem> table_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const ReportedRow& row : reported_rows()) {
    out.push_back(row.variant == kOrb ? level_item(cells, row) : change_item(cells, row));
    const std::string flaw = contradiction(row);
    if (flaw.empty()) continue;
    out.push_back({fmt::format("Table {}, {}", row.table, row.variant),
                   fmt::format("mean {}, ATE {}, RPE {}", row.mean, row.ate, row.rpe),
                   flaw,
                   "",
                   Verdict::contradicts_itself});
  }
  out.push_back(
      {"Section 4",
       "five indicators: maximum, minimum, average, absolute and relative trajectory error",
       "alignment, times and the interval of the RPE are not stated. Ours: after a rigid fit "
       "(monocular: with scale), at keyframes and densely at the stamps of the reference, "
       "RPE over one keyframe along the same axis. The minimum only shows how many errors "
       "were drawn",
       "",
       Verdict::cannot_be_judged});
  out.push_back(better_rows_item(cells));
  out.push_back(text_against_table(1, "N4"));
  out.push_back(text_against_table(4, "M7"));
  using enum metrics::Times;
  const std::vector<std::string> planar{"N3", "N4 parabola", "N4 cubic", "N5"};
  const std::vector<std::string> spatial{"M6", "M7", "M8"};
  out.push_back(
      best_item(cells, "Table 1, mean and ATE", "fr1_room", "y", "N3", planar, keyframes));
  out.push_back(best_item(cells, "Text, figure 6", "fr1_room", "y", "N4", planar, dense));
  out.push_back(best_item(cells, "Table 2, ATE", "fr1_room", "z", "M6", spatial, dense));
  out.push_back(best_item(cells, "Text, figure 8", "fr3_office", "y", "N4", planar, dense));
  out.push_back(best_item(cells, "Table 4, ATE", "fr3_office", "z", "M6", spatial, dense));
  out.push_back(best_item(cells, "Text, figure 8", "fr3_office", "z", "M7", spatial, dense));
  return out;
}

}  // namespace loopbench::harness
