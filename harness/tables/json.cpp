#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/tables/table.hpp"

namespace loopbench::harness {

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
        const TableMean mean = line[c].mean.value_or(TableMean{});
        means.push_back({{"value", or_null(mean.value)},
                         {"records", mean.records},
                         {"averaged", mean.averaged},
                         {"deviation", or_null(mean.deviation)},
                         {"possible", std::max(mean.records, mean.possible)},
                         {"status", mean.value ? "ok" : mean.status},
                         {"mark", line[c].is_best ? "best" : ""}});
      }
    }
    out.push_back({{"title", table.title},
                   {"row_names", table.headings[0]},
                   {"columns", std::vector(table.headings.begin() + 1, table.headings.end())},
                   {"rows", std::move(rows)},
                   {"notes", table.notes},
                   {"cells", std::move(cells)}});
  }
  const auto replace = Json::error_handler_t::replace;  // names can be invalid UTF-8
  return out.dump(2, ' ', false, replace) + "\n";
}

}  // namespace loopbench::harness
