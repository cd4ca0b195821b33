#include "harness/tables/all_records.hpp"

#include <iterator>

#include "harness/store/store.hpp"
#include "harness/tables/derived.hpp"

namespace loopbench {

std::vector<Record> all_records(const std::filesystem::path& store) {
  std::vector<Record> records = read_records(store);
  const auto run = read_run(store);
  std::vector<Record> gain = gains(records, run.at("baseline"));
  std::vector<Record> pairs = pair_counts(records);
  std::vector<Record> time = run_times(records);
  for (std::vector<Record>* more : {&gain, &pairs, &time}) {
    records.insert(
        records.end(), std::move_iterator(more->begin()), std::move_iterator(more->end()));
  }
  return records;
}

}  // namespace loopbench
