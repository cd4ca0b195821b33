#include "harness/store/differing_cells.hpp"

#include <map>
#include <tuple>

#include "harness/store/cell_rows.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {
namespace {

using CellIdentity =
    std::tuple<std::uint64_t, std::uint64_t, std::string, std::int64_t, std::string>;

CellIdentity identity_of(const CellRow& cell) {
  return {cell.key.low, cell.key.high, cell.sequence, cell.repeat, cell.method};
}

std::string differing_part(const CellRow& a, const CellRow& b) {
  if (a.status != b.status) return "status";
  for (const char* part : {"score_value", "count", "note", "section", "trace"}) {
    const Hash& own = a.details[detail_number(part)];
    const Hash& other = b.details[detail_number(part)];
    const bool is_optional = part == std::string("trace") && (own == Hash{} || other == Hash{});
    if (!is_optional && own != other) return part == std::string("score_value") ? "score" : part;
  }
  return "";
}

}  // namespace

std::vector<CellDifference> differing_cells(const std::filesystem::path& sample,
                                            const std::filesystem::path& store) {
  Database few = open_store(sample);
  const CellRows rows = read_cell_rows(few);
  require_intact(rows, store_file(sample));
  std::map<CellIdentity, const CellRow*> wanted;
  for (const CellRow& cell : rows.cells) {
    if (cell.placed) wanted.emplace(identity_of(cell), &cell);
  }
  Database all = open_store(store);
  const CellRows stored = read_cell_rows(all);
  require_intact(stored, store_file(store));
  std::vector<CellDifference> out;
  for (const CellRow& cell : stored.cells) {
    const auto found = cell.placed ? wanted.find(identity_of(cell)) : wanted.end();
    if (found == wanted.end()) continue;
    const std::string part = differing_part(*found->second, cell);
    if (!part.empty()) out.push_back({label_of(cell), part});
    wanted.erase(found);
  }
  for (const auto& [identity, cell] : wanted) out.push_back({label_of(*cell), "missing"});
  return out;
}

}  // namespace loopbench::harness
