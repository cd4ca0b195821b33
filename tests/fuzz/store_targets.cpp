#include "harness/answers/report/report.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/store/traces.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace loopbench {

using namespace harness;

namespace {

/// Calls `act` with the input as a store.
template <class Act>
void with_store(const std::filesystem::path& input, Act act) {
  const std::filesystem::path folder = fuzz_folder();
  const std::filesystem::path store = fuzz_file(folder, "results.sqlite", fuzz_bytes(input));
  unless_rejected([&] { act(store); });
  std::filesystem::remove_all(folder);
}

}  // namespace

void fuzz_store(const std::filesystem::path& file) {
  with_store(file, [](const std::filesystem::path& store) {
    Traces traces(store);
    for (const CellRow& cell : read_cells(store)) {
      traces.cell(cell.position);
      traces.sequence(cell.position);
    }
    read_records(store);
    read_run(store);
    read_provenance(store);
    read_inputs(store);
  });
}

void fuzz_report(const std::filesystem::path& file) {
  with_store(file,
             [](const std::filesystem::path& store) { report_html(read_report_content(store)); });
}

}  // namespace loopbench
