#include "harness/store/cell_times.hpp"

#include "harness/store/open.hpp"

namespace loopbench::harness {

void for_each_time(
    const std::filesystem::path& store,
    const std::function<void(const std::string& sequence, const std::string& method, double time)>&
        visit) {
  Database database = open_store(store);
  Statement row = database.prepare(
      "SELECT sequence, method, runs * coalesce(cpu_seconds_median, seconds_median) FROM cell NOT "
      "INDEXED WHERE position IS NOT "
      "NULL AND runs > 0");
  while (row.step()) {
    const std::string sequence = row.text();
    const std::string method = row.text();
    visit(sequence, method, row.real());
  }
}

}  // namespace loopbench::harness
