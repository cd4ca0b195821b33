#include "harness/store/recorded_contents.hpp"

#include <map>
#include <utility>

#include "harness/model/recorded_run.hpp"

namespace loopbench::harness {

void join_recorded_contents(Database& database,
                            const std::vector<StoredCell>& cells,
                            const std::vector<std::size_t>& order,
                            SequenceRows& sequences) {
  Statement config = database.prepare("SELECT value FROM run WHERE key = 'config'");
  if (!config.step() || !is_recorded(config.text())) return;
  const auto run_of = [&](std::size_t i) {
    return std::pair(cells[i].sequence.text(), cells[i].repeat);
  };
  std::map<std::pair<std::string, std::int64_t>, std::map<std::string, std::string>> runs;
  for (const std::size_t i : order) {
    const auto row = sequences.find(cells[i].sequence_key);
    runs[run_of(i)][cells[i].method] = row == sequences.end() ? "" : row->second.content;
  }
  for (const std::size_t i : order) {
    const auto row = sequences.find(cells[i].sequence_key);
    if (row != sequences.end()) row->second.content = recorded_content(runs.at(run_of(i)));
  }
}

}  // namespace loopbench::harness
