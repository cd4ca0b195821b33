#include "harness/store/differing_cells.hpp"

#include <map>
#include <tuple>
#include <utility>

#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {
namespace {

using CellIdentity = std::tuple<std::string, std::string, std::int64_t, std::string>;

CellIdentity identity_of(const StoredCell& cell) {
  return {cell.key, cell.sequence, cell.repeat, cell.method};
}

/// Parts of a cell and their queries.
constexpr std::pair<const char*, const char*> kParts[] = {
    {"score",
     "SELECT protocol, protocol_version, times, metric, label, relation, axis, unit, better, "
     "target, count, rmse, mean, median, std, min, max, sse, pairs, possible, span, status, why "
     "FROM score WHERE cell = ? ORDER BY number"},
    {"count", "SELECT name, value FROM count WHERE cell = ? ORDER BY number"},
    {"note", "SELECT text FROM note WHERE cell = ? ORDER BY number"},
    {"section",
     "SELECT kind, begin_stamp, end_stamp, what FROM section WHERE cell = ? ORDER BY number"},
    {"trace", "SELECT times, samples FROM trace WHERE cell = ?"}};

std::string rows_of(Database& database, const char* query, std::int64_t cell) {
  std::string out;
  Statement row = database.prepare(query);
  row.bind(cell);
  while (row.step()) row.append_columns(0, row.columns(), out);
  return out;
}

std::string differing_part(Database& sample,
                           const StoredCell& a,
                           Database& store,
                           const StoredCell& b) {
  if (a.status != b.status) return "status";
  for (const auto& [part, query] : kParts) {
    const std::string own = rows_of(sample, query, a.id);
    const std::string other = rows_of(store, query, b.id);
    const bool is_optional = part == std::string("trace") && (own.empty() || other.empty());
    if (!is_optional && own != other) return part;
  }
  return "";
}

}  // namespace

std::vector<CellDifference> differing_cells(const std::filesystem::path& sample,
                                            const std::filesystem::path& store) {
  Database few = open_store(sample);
  const std::vector<StoredCell> cells = checked_cells(few, true);
  require_intact(few, cells);
  std::map<CellIdentity, const StoredCell*> wanted;
  for (const StoredCell& cell : cells) {
    if (cell.placed) wanted.emplace(identity_of(cell), &cell);
  }
  Database all = open_store(store);
  const std::vector<StoredCell> stored = checked_cells(all, false);
  require_intact(all, stored);
  std::vector<CellDifference> out;
  for (const StoredCell& cell : stored) {
    const auto found = cell.placed ? wanted.find(identity_of(cell)) : wanted.end();
    if (found == wanted.end()) continue;
    const std::string part = differing_part(few, *found->second, all, cell);
    if (!part.empty()) out.push_back({label_of(cell), part});
    wanted.erase(found);
  }
  for (const auto& [identity, cell] : wanted) out.push_back({label_of(*cell), "missing"});
  return out;
}

}  // namespace loopbench::harness
