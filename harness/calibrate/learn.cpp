#include "harness/calibrate/learn.hpp"

#include <algorithm>

#include "harness/execution/run/sequences.hpp"
#include "harness/text/pattern.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kGroupLengths[] = {1, 5, 20, 50};
constexpr std::size_t kSegment = 10;  // block length of the bootstrap [groups of edges]
constexpr std::uint64_t kSeed = 1;

std::vector<CalibrationResiduals> residuals_of(
    const std::vector<std::shared_ptr<const Sequence>>& sequences,
    const std::vector<std::string>& labels,
    std::size_t every) {
  std::vector<CalibrationResiduals> out;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    CalibrationResiduals all = residuals(*sequences[i], labels[i], every);
    if (all.edges.size() > 1) out.push_back(std::move(all));
  }
  return out;
}

}  // namespace

Calibration learn(const Sweep& sweep,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  const LearnOptions& options) {
  const Pattern train = Pattern::of_option("--train", options.train);
  std::vector<Cell> selected;
  Calibration out;
  out.config = sweep.config.filename().string();
  out.every = options.every;
  for (std::size_t d = 0; d < sweep.datasets.size(); ++d) {
    if (train.is_in(sweep.datasets[d].label)) {
      selected.push_back({.index = selected.size(), .dataset = d});
    } else {
      out.not_trained_on.push_back(sweep.datasets[d].label);
    }
  }
  if (selected.empty()) {
    throw InputError(sweep.config.string() + ": no dataset's label matches '" + options.train +
                     "'");
  }

  Sequences sequences(sweep, catalogue, root, selected);
  std::vector<std::shared_ptr<const Sequence>> loaded;
  std::vector<std::string> labels;
  for (const Cell& cell : selected) {
    loaded.push_back(sequences.get(cell));
    labels.push_back(sweep.datasets[cell.dataset].label);
    const std::string& source = sequences.metadata(cell)->source;
    if (std::ranges::count(out.sources, source) == 0) out.sources.push_back(source);
  }
  out.sequences = residuals_of(loaded, labels, out.every);
  if (out.sequences.empty()) {
    throw InputError(sweep.config.string() + ": no dataset has two groups of " +
                     std::to_string(out.every) + " edges; reduce --every");
  }
  for (const std::size_t edges : kGroupLengths) {
    const std::vector<CalibrationResiduals> at = residuals_of(loaded, labels, edges);
    if (at.size() < out.sequences.size()) break;
    out.group_errors.push_back({edges,
                                {root_mean_square(methods::Component::translation, at),
                                 root_mean_square(methods::Component::rotation, at)}});
  }
  out.models = fit_nested_models(out.sequences);
  for (const NestedModel& model : out.models) {
    out.intervals.push_back(bootstrap(model, out.sequences, kSegment, options.draws, kSeed));
  }
  return out;
}

}  // namespace loopbench::harness
