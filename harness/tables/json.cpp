#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/tables/text.hpp"

namespace loopbench::harness {

std::string json(const std::vector<Table>& tables) {
  using Json = nlohmann::ordered_json;
  const auto replace = Json::error_handler_t::replace;  // names can be invalid UTF-8
  Json out = Json::array();
  for (const Table& table : tables) {
    Json entry{{"title", table.title},
               {"row_names", table.corner},
               {"columns", table.columns},
               {"rows", table.rows},
               {"notes", table.notes},
               {"cells", Json::array()}};
    for (const auto& row : table.cells) {
      Json line = Json::array();
      for (const TableCell& cell : row) {
        line.push_back({{"value", cell.value ? Json(*cell.value) : Json(nullptr)},
                        {"records", cell.records},
                        {"averaged", cell.averaged},
                        {"deviation", cell.deviation ? Json(*cell.deviation) : Json(nullptr)},
                        {"possible", std::max(cell.records, cell.possible)},
                        {"status", cell.value ? "ok" : cell.status},
                        {"mark", mark_name(cell.mark)}});
      }
      entry["cells"].push_back(std::move(line));
    }
    out.push_back(std::move(entry));
  }
  return out.dump(2, ' ', false, replace) + "\n";
}

}  // namespace loopbench::harness
