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

namespace {

struct LedgerSection {
  const char* title;
  const char* note;  ///< how the numbers are computed; may be empty
  std::vector<LedgerItem> items;
};

const char* const kVerdictRules =
    "\nThe closed run, the article's own kind of input, decides; the column of all runs shows how "
    "far one run can be trusted.\n\n"
    "| verdict | rule |\n| --- | --- |\n"
    "| holds | a change of the printed sign, within a factor of two of the printed size; the "
    "smallest error; a level within a factor of two; a curve as near as the printed ATE |\n"
    "| same sign, other size | a change of the printed sign and another size; a part of the "
    "statement holds |\n"
    "| tie | differences below 1 %; below 5 % between curves fitted to few keyframes |\n"
    "| does not hold | our computation gives another sign, order or size; the article's own run, "
    "which is not public, may differ |\n"
    "| contradicts itself | cannot be true as printed, whatever the data |\n"
    "| misprint or gap | a wrong or missing symbol or number, repaired as stated |\n"
    "| cannot be judged | depends on what is neither public nor stated |\n";

}  // namespace

std::string ledger(const std::vector<PaperCell>& cells) {
  const std::vector<LedgerSection> sections{
      {"Equations", "", equation_items(cells)},
      {"Datasets and thresholds", "", dataset_items(cells)},
      {"Tables 1 to 4",
       "Changes against the raw keyframes, with windows end to end; columns of "
       "[tables](tables.md).",
       table_items(cells)},
      {"Figures 5 to 8: which curve fits best",
       "Curves are fitted to the reference at the keyframes, in axes along the chord of each "
       "window, "
       "which favours no family; the error is that between the keyframes.",
       segment_items(cells)},
      {"Printed coefficients",
       "The best of a search along the path of the reference, in its axes. The path of the other "
       "sequence shows how near a curve comes by chance.",
       coefficient_items(cells)},
      {"The complete trajectory", "The readings `text`.", trajectory_items(cells)},
      {"The same claims for our readings",
       "`guarded` has guards that the article does not mention, and the natural spline fits no "
       "curve of the article: not statements of the article, but what its claims could rest on.",
       own_reading_items(cells)},
  };
  std::string head = "| statements on | number |";
  std::string rule = "| --- | ---: |";
  for (const auto& [name, verdict] : choices(Verdict{})) {
    head += fmt::format(" {} |", name);
    rule += " ---: |";
  }
  std::string summary = head + "\n" + rule + "\n";
  std::string body;
  for (const auto& [title, note, items] : sections) {
    body += fmt::format("\n## {}\n\n", title);
    if (*note != '\0') body += fmt::format("{}\n\n", note);
    body += ledger_table(items);
    summary += fmt::format("| {} | {} |", title, items.size());
    for (const auto& [name, verdict] : choices(Verdict{})) {
      summary += fmt::format(" {} |", std::ranges::count(items, verdict, &LedgerItem::verdict));
    }
    summary += "\n";
  }
  return summary + kVerdictRules + body;
}

}  // namespace loopbench::harness
