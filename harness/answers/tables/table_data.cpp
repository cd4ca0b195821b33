#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/answers/tables/record_csv.hpp"
#include "harness/answers/tables/table.hpp"

namespace loopbench::harness {
namespace {

/// "best", "stated", "best stated" or empty.
std::string mark_of(const TableCell& cell) {
  std::string out = cell.is_best ? "best" : "";
  if (cell.is_stated) out += out.empty() ? "stated" : " stated";
  return out;
}

}  // namespace

std::string csv(const std::vector<Table>& tables) {
  std::string out = "table,row,column,value,records,averaged,status,mark\n";
  for (const Table& table : tables) {
    for (const auto& line : table.lines) {
      for (std::size_t c = 1; c < line.size(); ++c) {
        const TableCell& cell = line[c];
        const std::string text = cell.has_mean ? "" : quoted(cell.text);
        const std::string value = cell.value ? fmt::format("{}", *cell.value) : text;
        if (value.empty() && cell.status.empty()) continue;
        out += fmt::format("{},{},{},{},{},{},{},{}\n",
                           quoted(table.title),
                           quoted(line[0].text),
                           quoted(table.headings[c]),
                           value,
                           cell.records,
                           cell.averaged,
                           value.empty() ? cell.status : "ok",
                           mark_of(cell));
      }
    }
  }
  return out;
}

std::string json(const std::vector<Table>& tables) {
  using Json = nlohmann::ordered_json;
  const auto or_null = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  Json out = Json::array();
  for (const Table& table : tables) {
    Json rows = Json::array();
    Json cells = Json::array();
    for (const auto& line : table.lines) {
      rows.push_back(line[0].text);
      Json& means = cells.emplace_back(Json::array());
      for (std::size_t c = 1; c < line.size(); ++c) {
        const TableCell& cell = line[c];
        const Json value = cell.has_mean ? or_null(cell.value) : Json(cell.text);
        means.push_back({{"value", value},
                         {"records", cell.records},
                         {"averaged", cell.averaged},
                         {"deviation", or_null(cell.deviation)},
                         {"possible", std::max(cell.records, cell.possible)},
                         {"status", value.is_null() ? cell.status : "ok"},
                         {"mark", mark_of(cell)}});
      }
    }
    out.push_back({{"title", table.title},
                   {"row_names", table.headings[0]},
                   {"columns", std::vector(table.headings.begin() + 1, table.headings.end())},
                   {"rows", std::move(rows)},
                   {"notes", note_texts(table)},
                   {"above", table.above},
                   {"cells", std::move(cells)}});
  }
  const auto replace = Json::error_handler_t::replace;  // names can be invalid UTF-8
  return out.dump(2, ' ', false, replace) + "\n";
}

}  // namespace loopbench::harness
