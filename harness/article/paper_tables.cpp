#include "harness/article/paper_tables.hpp"

#include <fmt/format.h>

#include "harness/article/reported.hpp"

namespace loopbench::harness {
namespace {

std::string line(const std::string& variant,
                 const std::string& source,
                 const AxisNumbers& n,
                 const std::string& dense,
                 const std::string& note) {
  return fmt::format("| {} | {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {} | {} |\n",
                     variant,
                     source,
                     n.max,
                     n.min,
                     n.mean,
                     n.ate,
                     n.rpe,
                     dense,
                     note);
}

std::string ours(const std::vector<PaperCell>& cells, const ReportedRow& row) {
  std::string out;
  for (const PaperCell& cell : cells) {
    if (cell.sequence != row.sequence || cell.variant != row.variant) continue;
    const std::string source = cell.input + (cell.reading.empty() ? "" : ", " + cell.reading);
    const char* note = cell.result.oracle_method ? "oracle: uses the reference" : "";
    const auto keyframes = axis_numbers(cell, row.axis, metrics::Times::keyframes);
    const auto dense = axis_numbers(cell, row.axis, metrics::Times::dense);
    if (!keyframes || !dense) {
      out += fmt::format("| {} | {} | | | | | | | {} |\n", row.variant, source, cell.result.why);
      continue;
    }
    out += line(row.variant, source, *keyframes, fmt::format("{:.4f}", dense->ate), note);
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
          "| variant | source | max | min | mean | ATE | RPE | ATE between keyframes | |\n"
          "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n",
          row.table,
          row.sequence,
          row.axis);
    }
    const std::string flaw = contradiction(row);
    out += line(row.variant,
                "**printed**",
                {row.max, row.min, row.mean, row.ate, row.rpe},
                "",
                flaw.empty() ? "" : "cannot be true: " + flaw);
    out += ours(cells, row);
  }
  return out;
}

}  // namespace loopbench::harness
