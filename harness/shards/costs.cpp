#include "harness/shards/costs.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/store/read.hpp"

namespace loopbench::harness {
namespace {

/// CPU time of a cell besides the method: its process, evaluation and storage [s].
constexpr double kOverhead = 4e-3;
/// CPU time of loading a sequence [s].
constexpr double kLoad = 20e-3;
constexpr double kUsualKeyframes = 300.0;
constexpr double kBytesPerPose = 80.0;  ///< of a line of a TUM file

/// CPU time of methods by the beginning of their names, for kUsualKeyframes of `simulated` [s]. The
/// first match counts; methods that are not listed take less than the overhead.
constexpr std::pair<std::string_view, double> kMethodSeconds[] = {
    {"motion_drift", 0.05},
    {"pose_graph_switchable", 0.16},
    {"pose_graph", 0.01},
    {"spline_fit", 0.2},
    {"spline_regression", 0.018},
    {"trend_filter", 0.1},
    {"gp_", 1.0},
};

double seconds_of(const MethodChoice& method) {
  double out = 0.0;
  for (const Choice& stage : method.stages) {
    const auto* const found = std::ranges::find_if(
        kMethodSeconds, [&](const auto& entry) { return stage.name.starts_with(entry.first); });
    if (found != std::end(kMethodSeconds)) out += found->second;
  }
  return out;
}

/// Size of a sequence relative to the usual one.
double relative_size(const DatasetChoice& choice,
                     const Catalogue& catalogue,
                     const DataRoot& root) {
  const Params options = full_options(choice, find_dataset(catalogue, choice.dataset.name), 0);
  double bytes = 0.0;
  for (const auto& [name, value] : options) {
    const auto* count = std::get_if<std::int64_t>(&value);
    if (name == "keyframes" && count != nullptr && *count > 0) {
      return static_cast<double>(*count) / kUsualKeyframes;
    }
    const auto* path = std::get_if<std::string>(&value);
    if (path == nullptr || path->empty()) continue;
    for (const std::filesystem::path& folder : root.folders) {
      std::error_code error;
      if (!std::filesystem::is_regular_file(folder / *path, error)) continue;
      bytes += static_cast<double>(std::filesystem::file_size(folder / *path, error));
      break;
    }
  }
  return bytes == 0.0 ? 1.0 : std::max(0.1, bytes / (kBytesPerPose * kUsualKeyframes));
}

struct Mean {
  double sum = 0.0;
  double count = 0.0;
  void add(double value) {
    sum += value;
    count += 1.0;
  }
};

}  // namespace

CellCosts estimated_costs(const Sweep& sweep,
                          const std::vector<Cell>& cells,
                          const Catalogue& catalogue,
                          const DataRoot& root) {
  std::vector<double> sizes;
  for (const DatasetChoice& dataset : sweep.datasets) {
    sizes.push_back(relative_size(dataset, catalogue, root));
  }
  std::vector<double> seconds;
  for (const MethodChoice& method : sweep.methods) {
    seconds.push_back(static_cast<double>(sweep.timing) * seconds_of(method));
  }
  CellCosts out{{}, kLoad};
  out.cells.reserve(cells.size());
  for (const Cell& cell : cells) {
    out.cells.push_back(kOverhead + sizes[cell.dataset] * seconds[cell.method]);
  }
  return out;
}

CellCosts measured_costs(const Sweep& sweep,
                         const std::vector<Cell>& cells,
                         const std::filesystem::path& store) {
  std::map<std::pair<std::string, std::string>, Mean> by_cell;
  std::map<std::string, Mean> by_method;
  Mean all;
  for_each_time(store, [&](const std::string& sequence, const std::string& method, double time) {
    by_cell[{sequence, method}].add(time);
    by_method[method].add(time);
    all.add(time);
  });
  if (all.count == 0.0) throw InputError(store.string() + ": has no times of cells");
  // Each pair of labels is looked up once, not for every repeat.
  std::map<std::pair<std::size_t, std::size_t>, double> known;
  CellCosts out{{}, kLoad};
  out.cells.reserve(cells.size());
  for (const Cell& cell : cells) {
    const auto [entry, is_new] = known.try_emplace({cell.dataset, cell.method});
    if (is_new) {
      const std::string& method = sweep.methods[cell.method].label;
      const auto exact = by_cell.find({sweep.datasets[cell.dataset].label, method});
      const auto similar = by_method.find(method);
      const Mean& mean = exact != by_cell.end()       ? exact->second
                         : similar != by_method.end() ? similar->second
                                                      : all;
      entry->second = kOverhead + mean.sum / mean.count;
    }
    out.cells.push_back(entry->second);
  }
  return out;
}

}  // namespace loopbench::harness
