#include <algorithm>
#include <future>
#include <set>
#include <unordered_map>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/stored_options.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLeastRecords = 4096;  ///< of a chunk, so that a thread is worth it

/// A cell among those that are read together.
using SharedCells = std::shared_ptr<std::vector<StoredCell>>;
Shared<CellRow> shared_cell(const SharedCells& cells, const StoredCell& cell) {
  return Shared<CellRow>(
      std::shared_ptr<CellRow>(cells, &(*cells)[static_cast<std::size_t>(&cell - cells->data())]));
}

std::map<std::int64_t, Shared<ScoreKind>> read_definitions(Database& database) {
  std::map<std::int64_t, Shared<ScoreKind>> out;
  Statement row = database.prepare("SELECT * FROM score_definition");
  while (row.step()) {
    ScoreKind k;
    std::string better;
    const std::int64_t id = row.integer();
    for (const KindField& each : kKindFields) row.read(k.*each.text);
    row.read(better, k.target);
    k.better = from_text<metrics::Better>(better).value_or(metrics::Better::neither);
    out.emplace(id, k);
  }
  return out;
}

/// The kinds of scores of all placed cells, in order of first appearance.
std::vector<Shared<ScoreKind>> kinds_of_all_cells(
    Database& database, const std::map<std::int64_t, Shared<ScoreKind>>& definitions) {
  std::vector<Shared<ScoreKind>> out;
  Statement row = database.prepare(
      "SELECT definition, min(position << 20 | number) AS first FROM score_value JOIN cell ON "
      "cell.id = cell WHERE position IS NOT NULL GROUP BY definition ORDER BY first");
  while (row.step()) {
    const auto found = definitions.find(row.integer());
    if (found != definitions.end()) out.push_back(found->second);
  }
  return out;
}

/// A metric that failed or was declined has no scores, hence one record without relation.
bool is_failed_metric(const ScoreKind& kind) {
  return !kind.metric.empty() && kind.relation.empty();
}

bool same_metric(const ScoreKind& a, const ScoreKind& b) {
  return a.protocol == b.protocol && a.times == b.times && a.metric == b.metric &&
         a.metric_label() == b.metric_label();
}

/// The scores of a failed metric on its run or, if it has none there, anywhere.
std::vector<Shared<ScoreKind>> kinds_of_metric(const ScoreKind& failed,
                                               const std::vector<Shared<ScoreKind>>& on_run,
                                               const std::vector<Shared<ScoreKind>>& anywhere) {
  std::vector<Shared<ScoreKind>> out;
  const auto add = [&](const Shared<ScoreKind>& kind) {
    if (kind->relation.empty() || !same_metric(*kind, failed)) return;
    if (std::ranges::count(out, kind) == 0) out.push_back(kind);
  };
  std::ranges::for_each(on_run, add);
  if (out.empty()) std::ranges::for_each(anywhere, add);
  return out;
}

/// Replaces the record of each failed metric by one for every score that the metric has.
void expand_failed_metrics(std::vector<Record>& records,
                           const std::vector<Shared<ScoreKind>>& anywhere) {
  const auto is_failed = [](const Record& r) {
    return r.status != Status::ok && is_failed_metric(*r.kind);
  };
  if (std::ranges::none_of(records, is_failed)) return;
  std::map<std::pair<SharedText, std::int64_t>, std::vector<Shared<ScoreKind>>> runs;
  for (const Record& r : records) runs[{r.cell->sequence, r.cell->repeat}].push_back(r.kind);
  std::vector<Record> out;
  for (const Record& r : records) {
    std::vector<Shared<ScoreKind>> kinds;
    if (is_failed(r)) {
      kinds = kinds_of_metric(*r.kind, runs.at({r.cell->sequence, r.cell->repeat}), anywhere);
    }
    if (kinds.empty()) out.push_back(r);
    for (const Shared<ScoreKind>& kind : kinds) out.emplace_back(r).kind = kind;
  }
  records = std::move(out);
}

/// In a store of evaluated files, replaces the content of every file by that of its run, see
/// evaluated_content(). In other stores, the methods of a run share a sequence.
void join_evaluated_contents(Database& database, std::vector<StoredCell>& cells) {
  Statement config = database.prepare("SELECT value FROM run WHERE key = 'config'");
  if (!config.step() || !is_of_files(config.text())) return;
  std::map<std::pair<SharedText, std::int64_t>, std::map<std::string, std::string>> runs;
  for (const StoredCell& cell : cells) {
    runs[{cell.sequence, cell.repeat}][cell.method] = cell.content;
  }
  for (StoredCell& cell : cells) {
    cell.content = evaluated_content(runs.at({cell.sequence, cell.repeat}));
  }
}

/// For each cell, whether every sequence that began up to there has ended.
std::vector<bool> ends_of_chunks(const std::vector<StoredCell>& cells) {
  std::unordered_map<std::string_view, std::size_t> last;
  for (std::size_t i = 0; i < cells.size(); ++i) last[cells[i].sequence.text()] = i;
  std::vector<bool> out(cells.size(), false);
  std::size_t end = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i == 0 || cells[i].sequence != cells[i - 1].sequence) {
      end = std::max(end, last.at(cells[i].sequence.text()));
    }
    out[i] = i == end;
  }
  return out;
}

}  // namespace

RecordReader::RecordReader(const std::filesystem::path& file)
    : database_(open_store(file)),
      cells_(std::make_shared<std::vector<StoredCell>>(read_intact_cells(database_))),
      definitions_(read_definitions(database_)) {
  join_evaluated_contents(database_, *cells_);
  add_options(database_, *cells_);
  const bool can_fail = std::ranges::any_of(
      definitions_, [](const auto& entry) { return is_failed_metric(*entry.second); });
  if (can_fail) kinds_anywhere_ = kinds_of_all_cells(database_, definitions_);
}

std::vector<Shared<ScoreKind>> RecordReader::kinds() const {
  std::vector<Shared<ScoreKind>> out;
  for (const auto& [id, kind] : definitions_) out.push_back(kind);
  return out;
}

void RecordReader::keep_scores(const std::function<bool(const ScoreKind&)>& is_kept) {
  kept_.clear();
  for (const auto& [id, kind] : definitions_) {
    if (is_kept(*kind)) kept_ += (kept_.empty() ? "" : ",") + std::to_string(id);
  }
  kept_ = " AND definition IN (" + kept_ + ")";
}

void RecordReader::step_scores() { row_cell_ = scores_->step() ? scores_->integer() : 0; }

void RecordReader::add_cell(const StoredCell& cell, std::vector<Record>& out) {
  Record own;
  own.cell = shared_cell(cells_, cell);
  own.status = cell.status;
  own.why = cell.why;
  if (cell.scores == 0) {  // declined or failed
    out.push_back(own);
    return;
  }
  // An incomplete cell can be complete at other times, so its scores have their own status.
  const bool is_incomplete = cell.status == Status::incomplete;
  const bool has_status = cell.status == Status::ok || is_incomplete;
  const bool has_reason = cell.why.empty() || is_incomplete;
  for (; row_cell_ == cell.id; step_scores()) {
    scores_->integer();  // number
    Record& r = out.emplace_back(own);
    r.kind = definitions_.at(scores_->integer());
    metrics::Statistics& s = r.statistics;
    scores_->read(s.count);
    for (const auto& each : metrics::kStatisticFields) scores_->read(s.*each.member);
    scores_->read(r.pairs, r.possible, r.span);
    const std::string_view status = scores_->view();
    if (has_status) r.status = from_text<Status>(std::string(status)).value_or(Status::failed);
    // The remark of a finished cell, for example that it has no reference, is no reason of a
    // failure.
    const bool has_failed = cell.status == Status::ok && r.status != Status::ok;
    if (has_reason || has_failed) scores_->read(r.why);
  }
}

void RecordReader::for_each_chunk(const std::function<bool(std::vector<Record>&)>& visit) {
  // CROSS JOIN: in the order of the cells, by their index.
  scores_.emplace(database_.prepare(
      "SELECT score_value.* FROM (SELECT id, position FROM cell WHERE position IS NOT NULL) CROSS "
      "JOIN score_value ON score_value.cell = id" +
      kept_ + " ORDER BY position, id, number"));
  step_scores();
  const std::vector<bool> is_end = ends_of_chunks(*cells_);
  std::size_t next = 0;
  std::size_t size = 0;  // of the last chunk
  const auto read = [&] {
    std::vector<Record> out;
    out.reserve(size + size / 2);  // callers add derived records
    while (next < cells_->size()) {
      add_cell((*cells_)[next], out);
      if (is_end[next++] && out.size() >= kLeastRecords) break;
    }
    size = out.size();
    expand_failed_metrics(out, kinds_anywhere_);
    return out;
  };
  // One chunk is read while the previous one is visited.
  std::future<std::vector<Record>> coming = std::async(std::launch::deferred, read);
  for (bool goes_on = next < cells_->size(); goes_on;) {
    std::vector<Record> records = coming.get();
    goes_on = next < cells_->size();
    if (goes_on) coming = std::async(std::launch::async, read);
    if (!visit(records)) return;  // waits for `coming`
  }
  scores_.reset();
}

void RecordReader::for_each(const std::function<void(const Record&)>& visit) {
  for_each_chunk([&](std::vector<Record>& records) {
    std::ranges::for_each(records, visit);
    return true;
  });
}

}  // namespace loopbench::harness
