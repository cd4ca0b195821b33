#include "harness/report/content.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/tables/all_records.hpp"

namespace loopbench::harness {
namespace {

void add_new(std::vector<std::string>& list, const std::string& text) {
  if (std::ranges::find(list, text) == list.end()) list.push_back(text);
}

}  // namespace

const Comparison* ReportContent::headline() const {
  const Comparison* out = nullptr;
  int best = -1;
  for (const Comparison& c : comparisons) {
    if (c.methods.size() < 2) continue;
    const bool is_ate =
        c.kind.metric == "ate" && c.kind.relation == "translation" && c.kind.axis == "3d";
    const int rank = (is_ate ? 2 : 0) + (c.kind.times == "dense" ? 1 : 0);
    if (rank <= best) continue;
    best = rank;
    out = &c;
  }
  return out;
}

ReportContent read_report_content(const std::filesystem::path& store) {
  ReportContent out;
  out.store = store;
  out.run = read_run(store);
  out.provenance = read_provenance(store);
  out.inputs = read_inputs(store);
  out.cells = read_cells(store);
  if (out.cells.empty()) throw InputError(store.string() + ": has no cells to report");
  out.records = all_records(store);
  for (const CellRecord& cell : out.cells) {
    add_new(out.sequences, cell.sequence);
    add_new(out.methods, cell.method);
  }
  const std::string baseline = out.run["baseline"];
  std::vector<Record> scores = out.records;
  // Gain equals the ratio of the comparison, and the profile covers pairs and times.
  std::erase_if(scores, [](const Record& r) {
    return r.metric == "gain" || r.metric == "pairs" || r.metric == "time";
  });
  const auto has_score = [](const Record& r) { return !r.metric.empty(); };
  if (!baseline.empty() && std::ranges::any_of(scores, has_score)) {
    CompareOptions options;
    options.baseline = baseline;
    out.comparisons = compare(scores, options);
  }
  return out;
}

}  // namespace loopbench::harness
