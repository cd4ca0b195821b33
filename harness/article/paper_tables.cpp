#include "harness/article/paper_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "harness/article/reported.hpp"

namespace loopbench::harness {
namespace {

std::string line(const std::string& variant,
                 const std::string& source,
                 const AxisNumbers& n,
                 const std::string& dense,
                 const std::string& runs,
                 const std::string& note) {
  return fmt::format("| {} | {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {} | {} | {} |\n",
                     variant,
                     source,
                     n.max,
                     n.min,
                     n.mean,
                     n.ate,
                     n.rpe,
                     dense,
                     runs,
                     note);
}

/// Range of a reading's ATE at keyframes over all runs of the sequence.
std::string over_runs(const std::vector<PaperCell>& cells,
                      const ReportedRow& row,
                      const PaperCell& like) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  std::size_t runs = 0;
  for (const PaperCell& cell : cells) {
    if (cell.sequence != row.sequence || cell.variant != like.variant ||
        cell.reading != like.reading)
      continue;
    const auto keyframes = axis_numbers(cell, row.axis, metrics::Times::keyframes);
    if (!keyframes) continue;
    low = std::min(low, keyframes->ate);
    high = std::max(high, keyframes->ate);
    ++runs;
  }
  return runs < 2 ? "" : fmt::format("{:.4f} to {:.4f} ({})", low, high, runs);
}

/// What a row uses of the reference.
std::string oracle_note(const PaperCell& cell) {
  for (const std::string& note : cell.result.report.notes) {
    if (note.starts_with("oracle")) return note;
  }
  return cell.result.oracle_method ? "oracle" : "";
}

std::string ours(const std::vector<PaperCell>& cells, const ReportedRow& row) {
  std::string out;
  for (const PaperCell& cell : cells) {
    if (cell.sequence != row.sequence || !cell.variant.starts_with(row.variant) ||
        cell.input != "closed")
      continue;
    const auto keyframes = axis_numbers(cell, row.axis, metrics::Times::keyframes);
    const auto dense = axis_numbers(cell, row.axis, metrics::Times::dense);
    const std::string source = cell.reading.empty() ? "raw keyframes" : cell.reading;
    if (!keyframes || !dense) {
      out += fmt::format("| {} | {} | | | | | | | | {} |\n", cell.variant, source, cell.result.why);
      continue;
    }
    out += line(cell.variant,
                source,
                *keyframes,
                fmt::format("{:.4f}", dense->ate),
                over_runs(cells, row, cell),
                oracle_note(cell));
  }
  return out;
}

}  // namespace

std::string paper_tables(const std::vector<PaperCell>& cells) {
  std::string out;
  int table = 0;
  for (const ReportedRow& row : reported_rows()) {
    if (row.table != table) {
      table = row.table;
      out += fmt::format(
          "\n### Table {}: {}, {} axis [m]\n\n"
          "| variant | source | max | min | mean | ATE | RPE | ATE densely | ATE at keyframes, all "
          "runs | |\n"
          "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n",
          row.table,
          row.sequence,
          row.axis);
    }
    const std::string flaw = contradiction(row);
    out += line(row.variant,
                "**printed**",
                {row.max, row.min, row.mean, row.ate, row.rpe},
                "",
                "",
                flaw.empty() ? "" : "contradicts itself: " + flaw);
    out += ours(cells, row);
  }
  return out;
}

}  // namespace loopbench::harness
