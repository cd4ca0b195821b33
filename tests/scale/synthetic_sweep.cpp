/// Writes stores of synthetic cells through the writer of sweeps, for measurements of reading.
///
/// synthetic_sweep FOLDER CELLS [SHARDS]   stores of CELLS cells (a multiple of 2000) of 20 scores
///                                         each: FOLDER, or FOLDER/shards/I-of-N
/// synthetic_sweep FOLDER CELLS resume     matches the store with its sweep, as `run` does
/// synthetic_sweep FOLDER CELLS one METHODS   a store whose cells are all of one sequence, 4 scores
///                                            each
///
/// Prints the processor time of each step and the largest resident size.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "harness/sweep/store/shard.hpp"
#include "harness/sweep/store/store.hpp"
#include "harness/sweep/text/hash.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace {

using namespace loopbench;
using namespace loopbench::harness;

constexpr std::size_t kMethods = 40;
constexpr std::size_t kRepeats = 50;
constexpr const char* kMetrics[] = {
    "ate", "rpe_1m", "rpe_10m", "path", "x", "y", "z", "roll", "pitch", "yaw"};

double uniform(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; }

/// 5 scores or more of translation and rotation at two kinds of times.
Sweep sweep_of(std::size_t cells, std::size_t methods, std::size_t repeats) {
  Sweep out;
  out.name = "synthetic";
  out.baseline = "m0";
  out.repeats = static_cast<int>(repeats);
  out.limits.cells = 100'000'000;
  for (const char* metric : kMetrics) out.metrics.push_back({metric, {"ate", {}}});
  for (std::size_t i = 0; i < cells / methods / repeats; ++i) {
    out.datasets.push_back(
        {fmt::format("sequence {}", i), {"line", {{"bias", 1e-6 * static_cast<double>(i)}}}});
  }
  for (std::size_t i = 0; i < methods; ++i) {
    out.methods.push_back({fmt::format("m{}", i), {{"shift", {{"by", static_cast<double>(i)}}}}});
  }
  return out;
}

CellResult result_of(const Cell& cell, std::size_t metrics) {
  CellResult out;
  out.cell = cell;
  out.worker.isolated = true;
  const Hash run = hash_of(fmt::format("{} {}", cell.dataset, cell.repeat));
  auto metadata = std::make_shared<SequenceMetadata>();
  metadata->group = metadata->content = hex(run);
  metadata->closures = "synthetic";
  metadata->size = {300, 299, 20, 0, 3000};
  out.metadata = std::move(metadata);
  const Hash own = hash_of(fmt::format("{} {}", hex(run), cell.method));
  out.seconds = {1e-3 * (1.0 + uniform(own.low))};
  out.cpu_seconds = out.seconds;
  for (const metrics::Times times : {metrics::Times::keyframes, metrics::Times::dense}) {
    for (std::size_t i = 0; i < metrics; ++i) {
      // The run decides most of the error, the method little of it.
      const double noise = uniform(hash_of(fmt::format("{} {}", hex(own), i)).low);
      const double error = (0.5 + uniform(run.low)) *
                           (1.0 + 0.01 * static_cast<double>(cell.method)) * (0.8 + 0.4 * noise);
      ScoreResult& score = out.scores.emplace_back();
      score.times = times;
      score.metric = kMetrics[i];
      score.score = {
          "translation", "3d", "m", {300, error, error, error, error, 0.0, error, error}};
      score.coverage.pairs = score.coverage.possible = 300;
      score.coverage.span = 1.0;
    }
  }
  return out;
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

void report(const char* step, std::size_t cells, double since) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("{} {} cells: {:.2f} s, {:.0f} MB\n",
             step,
             cells,
             processor_seconds() - since,
             1e-3 * static_cast<double>(usage.ru_maxrss));
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    fmt::print("usage: synthetic_sweep FOLDER CELLS [SHARDS | resume | one METHODS]\n");
    return 2;
  }
  const std::filesystem::path folder = words[1];
  const std::string mode = count > 3 ? words[3] : "1";
  const auto number = [&](int i) -> std::size_t { return std::strtoull(words[i], nullptr, 10); };
  const bool is_one = mode == "one" && count > 4;
  const std::size_t methods = is_one ? number(4) : kMethods;
  const Sweep sweep = sweep_of(number(2), methods, is_one ? number(2) / methods : kRepeats);
  const Catalogue known = tiny::catalogue();
  const std::vector<Cell> all = cells(sweep, std::vector<bool>(sweep.datasets.size(), true), "");
  CellKeys keys(sweep, known, DataRoot{{folder}}, "synthetic");
  double begin = processor_seconds();
  if (mode == "resume") {
    Store store(folder / "results.sqlite", keys, {});
    const Resumed found = store.resume(all, all, Retry::none);
    report("resume", found.there, begin);
    return found.there == all.size() ? 0 : 1;
  }
  const std::size_t shards = is_one ? 1 : std::strtoull(mode.c_str(), nullptr, 10);
  for (std::size_t i = 1; i <= shards; ++i) {
    const Shard shard{i, shards};
    const std::filesystem::path own = shards == 1 ? folder : folder / "shards" / shard.folder();
    const std::vector<Cell> planned = cells_of(shard, all);
    Store store(own / "results.sqlite", keys, {});
    if (shards > 1) store.set_shard(shard.name() + " " + division_hash(all));
    store.resume(all, planned, Retry::none);
    for (const Cell& cell : planned) store.write(result_of(cell, is_one ? 2 : std::size(kMetrics)));
  }
  report("write", all.size(), begin);
  return 0;
}
