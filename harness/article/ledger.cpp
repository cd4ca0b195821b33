#include "harness/article/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/core/fields.hpp"

namespace loopbench::harness {

std::vector<const PaperCell*> raw_runs(const std::vector<PaperCell>& cells,
                                       const std::string& sequence) {
  std::vector<const PaperCell*> out;
  for (const PaperCell& cell : cells) {
    if (!cell.is_baseline() || cell.sequence != sequence || cell.keyframes.empty()) continue;
    out.insert(cell.input == "closed" ? out.begin() : out.end(), &cell);
  }
  return out;
}

std::string ledger_table(const std::vector<LedgerItem>& items) {
  std::string out =
      "| where | the article | ours, closed run | all runs | verdict |\n"
      "| --- | --- | --- | --- | --- |\n";
  for (const LedgerItem& item : items) {
    out += fmt::format("| {} | {} | {} | {} | *{}* |\n",
                       item.where,
                       item.statement,
                       item.ours,
                       item.runs,
                       to_text(item.verdict));
  }
  return out;
}

std::string ledger(const std::vector<PaperCell>& cells) {
  const std::vector<std::pair<const char*, std::vector<LedgerItem>>> sections{
      {"Equations", equation_items(cells)},
      {"Datasets and thresholds", dataset_items(cells)},
      {"Tables 1 to 4", table_items(cells)},
      {"Figures 5 to 8: which curve fits best", segment_items(cells)},
      {"Printed coefficients", coefficient_items(cells)},
      {"The complete trajectory", trajectory_items(cells)},
  };
  std::string head = "| statements on | number |";
  std::string rule = "| --- | ---: |";
  for (const auto& [name, verdict] : choices(Verdict{})) {
    head += fmt::format(" {} |", name);
    rule += " ---: |";
  }
  std::string summary = head + "\n" + rule + "\n";
  std::string body;
  for (const auto& [title, items] : sections) {
    body += fmt::format("\n## {}\n\n{}", title, ledger_table(items));
    summary += fmt::format("| {} | {} |", title, items.size());
    for (const auto& [name, verdict] : choices(Verdict{})) {
      summary += fmt::format(" {} |", std::ranges::count(items, verdict, &LedgerItem::verdict));
    }
    summary += "\n";
  }
  return summary + body;
}

}  // namespace loopbench::harness
