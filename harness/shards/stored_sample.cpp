#include "harness/shards/stored_sample.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "datasets/core/error.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/execution/isolate/isolated_sweep.hpp"
#include "harness/store/resume.hpp"
#include "harness/store/store.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// Folder that is removed on destruction.
class SampleFolder {
 public:
  SampleFolder()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("loopbench-sample-{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~SampleFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SampleFolder(const SampleFolder&) = delete;
  SampleFolder& operator=(const SampleFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Cells that the store has, in a pseudo-random but fixed selection.
std::vector<Cell> sampled(const std::vector<Cell>& planned,
                          const std::vector<Cell>& missing,
                          double share) {
  std::set<std::size_t> absent;
  for (const Cell& cell : missing) absent.insert(cell.index);
  std::vector<Cell> out;
  const Cell* first = nullptr;
  std::uint64_t lowest = 0;
  for (const Cell& cell : planned) {
    if (absent.contains(cell.index)) continue;
    const std::uint64_t drawn = hash_of("sample " + std::to_string(cell.index)).low;
    if (static_cast<double>(drawn) < share * 0x1p64) out.push_back(cell);
    if (first == nullptr || drawn < lowest) {
      first = &cell;
      lowest = drawn;
    }
  }
  if (out.empty() && first != nullptr) out.push_back(*first);
  return out;
}

}  // namespace

RecomputedSample recompute_sample(
    const SweepSetting& setting,
    const SampleArguments& arguments,
    const StopRequests& stop,
    const std::function<void(std::size_t cells, const std::string& label)>& on_cell) {
  const auto& [sweep, catalogue, root, build] = setting;
  const std::vector<bool> with_seed = seeded(sweep, catalogue);
  const std::vector<Cell> all = cells(sweep, with_seed, "");
  const std::vector<Cell> planned = cells(sweep, with_seed, arguments.only);
  CellKeys keys(sweep, catalogue, root, build);
  const std::vector<Cell> sample =
      sampled(planned, missing_cells(arguments.store, keys, all, planned), arguments.share);
  if (sample.empty()) {
    throw InputError(arguments.store.string() +
                     ": has no cell of this config that was computed by this build");
  }
  const SampleFolder folder;
  const std::filesystem::path file = folder.path() / "results.sqlite";
  {
    CellKeys own_keys(sweep, catalogue, root, build);
    Store store(file, own_keys, {});
    SandboxOptions sandbox;
    sandbox.hidden = {arguments.store};
    const std::vector<Cell> missing = store.resume(all, sample, Retry::none).missing;
    run_isolated(
        sweep, missing, catalogue, root, arguments.jobs, sandbox, stop, [&](const auto& r) {
          if (r.status != Status::interrupted) store.write(r);
          on_cell(sample.size(), setting.sweep.datasets[r.cell.dataset].label);
        });
  }
  if (stop > 0) return {sample.size(), {}};
  return {sample.size(), differing_cells(file, arguments.store)};
}

}  // namespace loopbench::harness
