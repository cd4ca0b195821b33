#include "harness/execution/run/oracle_method.hpp"

#include <algorithm>

namespace loopbench::harness {

bool is_shown_reference(const MethodChoice& method, const Catalogue& catalogue) {
  return std::ranges::any_of(method.stages, [&](const Choice& stage) {
    return find_oracle(catalogue, stage.name) != nullptr;
  });
}

std::string trained_on_judged(const MethodChoice& method,
                              const DatasetChoice& dataset,
                              const SequenceFacts& facts) {
  const TrainingData& data = method.trained_on;
  const bool by_source = std::ranges::count(data.sources, facts.source) > 0;
  const bool by_label = data.sources.empty() && std::ranges::count(data.labels, dataset.label) > 0;
  if (by_source) return data.calibration + " was trained on the reference of this sequence";
  if (by_label) return data.calibration + " was trained on a dataset with this label";
  return "";
}

void flag_trained_on_judged(CellResult& result, const Sweep& sweep) {
  if (!result.facts) return;
  const std::string why = trained_on_judged(
      sweep.methods[result.cell.method], sweep.datasets[result.cell.dataset], *result.facts);
  if (why.empty()) return;
  result.oracle_method = true;
  result.report.notes.push_back("oracle: " + why);
}

}  // namespace loopbench::harness
