#include "harness/execution/run/oracle_method.hpp"

#include <algorithm>

namespace loopbench::harness {

bool uses_reference(const MethodChoice& method, const Catalogue& catalogue) {
  return std::ranges::any_of(method.stages, [&](const Choice& stage) {
    return find_oracle(catalogue, stage.name) != nullptr;
  });
}

std::string trained_on_evaluated(const MethodChoice& method,
                                 const DatasetChoice& dataset,
                                 const SequenceMetadata& metadata) {
  const TrainingData& data = method.trained_on;
  const bool by_source = std::ranges::count(data.sources, metadata.source) > 0;
  const bool by_label = data.sources.empty() && std::ranges::count(data.labels, dataset.label) > 0;
  if (by_source) return data.calibration + " was trained on the reference of this sequence";
  if (by_label) return data.calibration + " was trained on a dataset with this label";
  return "";
}

void flag_trained_on_evaluated(CellResult& result, const Sweep& sweep) {
  if (!result.metadata) return;
  const std::string why = trained_on_evaluated(
      sweep.methods[result.cell.method], sweep.datasets[result.cell.dataset], *result.metadata);
  if (why.empty()) return;
  result.oracle_method = true;
  result.report.notes.push_back("oracle: " + why);
}

}  // namespace loopbench::harness
