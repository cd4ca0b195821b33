#include "harness/execution/run/oracle_method.hpp"

#include <algorithm>

namespace loopbench::harness {

bool uses_reference(const MethodChoice& method, const Catalogue& catalogue) {
  return std::ranges::any_of(method.stages,
                             [&](const Choice& stage) { return is_oracle(catalogue, stage.name); });
}

bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference) {
  constexpr double kTolerance = 1e-9;  // of the size
  if (reference.size() < 3 || reference.size() != estimate.size()) return false;
  double size = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto& position = reference[i].world_from_body.translation;
    size = std::max(size, (position - reference.front().world_from_body.translation).norm());
    difference = std::max(difference, (estimate[i].world_from_body.translation - position).norm());
  }
  return size > 0.0 && difference <= kTolerance * size;
}

std::string trained_on_evaluated(const MethodChoice& method,
                                 const DatasetChoice& dataset,
                                 const SequenceMetadata& metadata) {
  const TrainingData& data = method.trained_on;
  const auto is_source = [&](const std::string& source) {
    return std::ranges::count(data.sources, source) > 0;
  };
  // Older calibrations have the hash of the bytes of the reference file.
  const bool by_file = std::ranges::any_of(
      metadata.inputs, [&](const InputFile& file) { return is_source("reference:" + file.hash); });
  const bool by_source = is_source(metadata.source) || by_file;
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
