#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/derived.hpp"
#include "harness/answers/compare/verdict.hpp"
#include "harness/answers/report/curve.hpp"
#include "harness/answers/report/report.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/store/read.hpp"

namespace loopbench::harness {
namespace {

/// Sets the comparisons, the scores without a value, and the records of the first sequences: those
/// that could fit into `bytes`, at least one.
void read_scores(const std::string& baseline, std::size_t bytes, ReportContent& out) {
  constexpr std::size_t kLeastBytesOfAScore = 10;
  RecordReader reader(out.store);
  CompareOptions options;
  options.baseline = baseline;
  ObservationsBuilder observed(options.value);
  std::set<SharedText> taken;
  reader.for_each([&](const Record& r) {
    if (!baseline.empty()) observed.add(r);
    if (r.has_score() && r.status != Status::ok) out.undefined.push_back(r);
    const bool has_room = out.records.size() < bytes / kLeastBytesOfAScore;
    if (taken.empty() || has_room) taken.insert(r.cell->sequence);
    if (taken.contains(r.cell->sequence)) out.records.push_back(r);
  });
  std::vector<Observations> all = observed.build();
  if (!all.empty()) out.comparisons = compare(std::move(all), options);
}

}  // namespace

std::string ReportContent::run_value(const std::string& key) const {
  const auto found = run.find(key);
  return found == run.end() ? "" : found->second;
}

const Comparison* ReportContent::headline() const { return harness::headline(comparisons); }

ReportWords words_of(const ReportContent& content) {
  if (!is_of_files(content.run_value("config"))) return {};
  return {.one = "estimate", .cell = "evaluation", .cells = "evaluations"};
}

void ReportContent::show(std::size_t count) {
  shown = std::min(count, shown);
  const std::set<std::string> kept(sequences.begin(),
                                   sequences.begin() + static_cast<std::ptrdiff_t>(shown));
  const auto is_hidden = [&](const CellRow& cell) { return !kept.contains(cell.sequence); };
  std::erase_if(shown_cells, is_hidden);
  std::erase_if(records, [&](const Record& r) { return is_hidden(*r.cell); });
}

ReportContent read_report_content(const std::filesystem::path& store, std::size_t bytes) {
  ReportContent out;
  out.store = store;
  out.run = read_run(store);
  out.provenance = read_provenance(store);
  out.inputs = read_inputs(store);
  const std::string baseline = out.run["baseline"];
  read_scores(baseline, bytes, out);
  out.cells = read_cells(store);
  out.notes = counted_notes(store);
  if (out.cells.empty()) throw InputError(store.string() + ": has no cells to report");
  NameOrder sequences, methods;
  for (const CellRow& cell : out.cells) {
    sequences.index(cell.sequence);
    methods.index(cell.method);
  }
  out.sequences = sequences.names();
  out.methods = methods.names();
  add_derived(out.records, baseline);
  // The page states changes instead.
  std::erase_if(out.records, [](const Record& r) { return r.kind->metric == "gain"; });
  std::set<SharedText> with_records;
  for (const Record& r : out.records) with_records.insert(r.cell->sequence);
  out.shown = out.sequences.size();
  for (const CellRow& cell : out.cells) {
    if (with_records.contains(cell.sequence)) out.shown_cells.push_back(cell);
  }
  out.show(with_records.size());
  return out;
}

std::vector<std::string> default_methods(const ReportContent& content) {
  constexpr std::size_t kMostMethods = 5;  // more lines are hard to distinguish
  std::vector<std::string> out;
  const auto add = [&](const std::string& name) {
    if (out.size() < kMostMethods && std::ranges::count(out, name) == 0) out.push_back(name);
  };
  const Comparison* headline = content.headline();
  if (headline == nullptr) {
    for (const std::string& name : content.methods) add(name);
    return out;
  }
  add(headline->options.baseline);
  std::set<std::string> chains;
  for (const CellRow& cell : content.cells) {
    if (!cell.parts.corrector.empty() && !cell.parts.smoother.empty()) chains.insert(cell.method);
  }
  for (const MethodVerdict& m : headline->methods) {
    const bool is_chain = chains.contains(m.method);
    if (m.method == headline->options.baseline || (is_chain && out.size() > 1)) continue;
    add(m.method);
    if (!chains.empty() && !is_chain) break;
  }
  return out;
}

std::vector<std::string> style_order(const ReportContent& content) {
  std::vector<std::string> out;
  const auto add = [&](const std::string& name) {
    if (std::ranges::count(content.methods, name) == 0 || std::ranges::count(out, name) > 0) return;
    out.push_back(name);
  };
  add(content.run_value("baseline"));
  // More methods than colours: those that are drawn by default must not share one.
  if (content.methods.size() > kCurveColors.size())
    std::ranges::for_each(default_methods(content), add);
  std::ranges::for_each(content.methods, add);
  return out;
}

}  // namespace loopbench::harness
