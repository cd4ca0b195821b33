#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/tables/text.hpp"

namespace loopbench::harness {

std::string json(const std::vector<Table>& tables) {
  using Json = nlohmann::ordered_json;
  const auto replace = Json::error_handler_t::replace;  // names can be invalid UTF-8
  Json out = Json::array();
  for (const Table& table : tables) {
    Json object{{"title", table.title},
                {"row_names", table.corner},
                {"columns", table.columns},
                {"rows", table.rows},
                {"notes", table.notes},
                {"cells", Json::array()}};
    for (const auto& row : table.entries) {
      Json line = Json::array();
      for (const TableEntry& entry : row) {
        line.push_back({{"value", entry.value ? Json(*entry.value) : Json(nullptr)},
                        {"records", entry.records},
                        {"averaged", entry.averaged},
                        {"deviation", entry.deviation ? Json(*entry.deviation) : Json(nullptr)},
                        {"possible", std::max(entry.records, entry.possible)},
                        {"status", entry.value ? "ok" : entry.status},
                        {"mark", mark_name(entry.mark)}});
      }
      object["cells"].push_back(std::move(line));
    }
    out.push_back(std::move(object));
  }
  return out.dump(2, ' ', false, replace) + "\n";
}

}  // namespace loopbench::harness
