#include <fmt/format.h>

#include "harness/tables/record_csv.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

std::string csv(const std::vector<Table>& tables) {
  std::string out = "table,row,column,value,records,averaged,status,mark\n";
  for (const Table& table : tables) {
    for (const auto& line : table.lines) {
      for (std::size_t c = 1; c < line.size(); ++c) {
        const TableMean mean = line[c].mean.value_or(TableMean{});
        if (!mean.value && mean.status.empty()) continue;
        out += fmt::format("{},{},{},{},{},{},{},{}\n",
                           quoted(table.title),
                           quoted(line[0].text),
                           quoted(table.headings[c]),
                           mean.value ? fmt::format("{}", *mean.value) : "",
                           mean.records,
                           mean.averaged,
                           mean.value ? "ok" : mean.status,
                           line[c].is_best ? "best" : "");
      }
    }
  }
  return out;
}

std::string text_csv(const Table& table) {
  std::string out = "table";
  for (const std::string& heading : table.headings) out += "," + quoted(heading);
  out += "\n";
  for (const auto& line : table.lines) {
    out += quoted(table.title);
    for (const TableCell& cell : line) out += "," + quoted(cell.text);
    out += "\n";
  }
  return out;
}

}  // namespace loopbench::harness
