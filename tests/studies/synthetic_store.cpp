#include "tests/studies/synthetic_store.hpp"

#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/store/store.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::synthetic {

using namespace metrics;

namespace {

Sweep sweep_of(const NameOrder& sequences, const NameOrder& methods) {
  Sweep out;
  out.name = "synthetic";
  out.baseline = "m0";
  out.times = {Times::dense};
  out.metrics = {{"ate", {"ate", {}}}};
  for (std::size_t i = 0; i < sequences.names().size(); ++i) {
    const Params own{{"seed", static_cast<std::int64_t>(i)}};
    out.datasets.push_back({sequences.names()[i], {"line", own}});
  }
  for (std::size_t i = 0; i < methods.names().size(); ++i) {
    const Params own{{"by", 1e-3 * static_cast<double>(i)}};
    out.methods.push_back({methods.names()[i], {{"shift", own}}});
  }
  return out;
}

CellResult result_of(const Record& record, const Cell& cell) {
  CellResult out;
  out.cell = cell;
  out.seconds = {1e-3};
  SequenceMetadata metadata;
  metadata.group = record.cell->group;
  metadata.group_kind = record.cell->group_kind;
  metadata.recording = record.cell->recording;
  metadata.content = record.cell->content;
  out.metadata = std::make_shared<const SequenceMetadata>(metadata);
  if (record.kind->metric.empty()) {
    out.status = Status::failed;
    out.why = "drawn to fail";
    return out;
  }
  ScoreResult score;
  score.times = Times::dense;
  score.metric = score.label = record.kind->metric;
  score.score = {record.kind->relation, record.kind->axis, record.kind->unit, record.statistics};
  score.score.statistics.count = 1;
  score.coverage.pairs = score.coverage.possible = 1;
  score.coverage.span = 1.0;
  out.scores.push_back(score);
  return out;
}

}  // namespace

void write_store(const std::vector<Record>& records, const std::filesystem::path& folder) {
  NameOrder sequences;
  NameOrder methods;
  for (const Record& r : records) {
    sequences.index(r.cell->sequence);
    methods.index(r.cell->method);
  }
  for (const char* tail : {"", "-wal", "-shm"}) {
    std::filesystem::remove(folder / (std::string("results.sqlite") + tail));
  }
  static const Catalogue known = tiny::catalogue();
  const Sweep sweep = sweep_of(sequences, methods);
  CellKeys keys(sweep, known, DataRoot{{folder}}, "synthetic");
  Store store(folder / "results.sqlite", keys, {});
  const std::vector<Cell> all = cells(sweep, std::vector<bool>(sweep.datasets.size(), false), "");
  store.resume(all, all, Retry::none);
  for (const Record& r : records) {
    const std::size_t place = sequences.index(r.cell->sequence) * sweep.methods.size();
    store.write(result_of(r, all.at(place + methods.index(r.cell->method))));
  }
}

}  // namespace loopbench::synthetic
