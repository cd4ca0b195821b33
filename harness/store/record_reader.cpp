#include "harness/store/record_reader.hpp"

#include <algorithm>
#include <future>
#include <set>
#include <tuple>
#include <unordered_map>

#include "datasets/core/error.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/store/open.hpp"
#include "harness/store/schema.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLeastRecords = 4096;  ///< of a chunk, so that a thread is worth it

/// Sets the common fields of all records of a cell.
void set_cell(Record& r, const StoredCell& cell) {
  r.cell = cell.position;
  r.sequence = cell.sequence;
  r.repeat = cell.repeat;
  r.method = cell.method;
  r.closures = cell.closures;
  r.oracle_closures = cell.oracle_closures;
  r.oracle = cell.oracle;
  const bool is_unknown = cell.runs == 0 && has_numbers(cell.status);
  r.milliseconds = is_unknown ? std::nan("") : cell.seconds * 1000;
  r.is_stated = cell.worker.text().ends_with(kStatedTimes);
  r.status = cell.status;
  r.why = cell.why;
  r.content = cell.content;
  r.group = cell.group;
}

std::map<std::int64_t, Record> read_definitions(Database& database) {
  std::map<std::int64_t, Record> out;
  Statement row =
      database.prepare(std::string("SELECT ") + kDefinitionColumns + ", id FROM score_definition");
  while (row.step()) {
    Record r;
    std::string better;
    std::int64_t id = 0;
    row.read(
        r.protocol, r.protocol_version, r.times, r.metric, r.label, r.relation, r.axis, r.unit);
    row.read(better, r.target, id);
    r.better = from_text<metrics::Better>(better).value_or(metrics::Better::neither);
    out.emplace(id, r);
  }
  return out;
}

/// The definitions of the scores of all placed cells, in order of first appearance.
std::vector<Record> scores_of_all_cells(Database& database,
                                        const std::map<std::int64_t, Record>& definitions) {
  std::vector<Record> out;
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
bool is_failed_metric(const Record& r) { return !r.metric.empty() && r.relation.empty(); }

bool same_metric(const Record& a, const Record& b) {
  return a.protocol == b.protocol && a.times == b.times && a.metric == b.metric &&
         metric_label(a) == metric_label(b);
}

/// The scores of the failed metric of `r` on its run or, if it has none there, anywhere.
std::vector<Record> scores_of_metric(const Record& r,
                                     const std::vector<const Record*>& on_run,
                                     const std::vector<Record>& anywhere) {
  std::vector<Record> out;
  std::set<std::tuple<SharedText, SharedText, SharedText>> known;
  const auto add = [&](const Record& score) {
    if (score.relation.empty() || !same_metric(score, r)) return;
    if (known.emplace(score.relation, score.axis, score.unit).second) out.push_back(score);
  };
  for (const Record* score : on_run) add(*score);
  if (out.empty()) std::ranges::for_each(anywhere, add);
  return out;
}

/// Replaces the record of each failed metric by one for every score that the metric has.
void expand_failed_metrics(std::vector<Record>& records, const std::vector<Record>& anywhere) {
  const auto is_failed = [](const Record& r) {
    return r.status != Status::ok && is_failed_metric(r);
  };
  if (std::ranges::none_of(records, is_failed)) return;
  std::map<std::pair<SharedText, std::int64_t>, std::vector<const Record*>> runs;
  for (const Record& r : records) runs[{r.sequence, r.repeat}].push_back(&r);
  std::vector<Record> out;
  for (const Record& r : records) {
    std::vector<Record> scores;
    if (is_failed(r)) scores = scores_of_metric(r, runs.at({r.sequence, r.repeat}), anywhere);
    if (scores.empty()) out.push_back(r);
    for (const Record& score : scores) {
      Record& named = out.emplace_back(r);
      named.relation = score.relation;
      named.axis = score.axis;
      named.unit = score.unit;
      named.better = score.better;
      named.target = score.target;
    }
  }
  records = std::move(out);
}

/// In a store of evaluated files, replaces the content of every file by that of its run, see
/// recorded_content(). In other stores, the methods of a run share a sequence.
void join_recorded_contents(Database& database, std::vector<StoredCell>& cells) {
  Statement config = database.prepare("SELECT value FROM run WHERE key = 'config'");
  if (!config.step() || !is_recorded(config.text())) return;
  std::map<std::pair<SharedText, std::int64_t>, std::map<std::string, std::string>> runs;
  for (const StoredCell& cell : cells) {
    runs[{cell.sequence, cell.repeat}][cell.method] = cell.content;
  }
  for (StoredCell& cell : cells) {
    cell.content = recorded_content(runs.at({cell.sequence, cell.repeat}));
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
      cells_(read_intact_cells(database_)),
      definitions_(read_definitions(database_)) {
  join_recorded_contents(database_, cells_);
  const bool can_fail = std::ranges::any_of(
      definitions_, [](const auto& entry) { return is_failed_metric(entry.second); });
  if (can_fail) scores_anywhere_ = scores_of_all_cells(database_, definitions_);
}

void RecordReader::for_each_definition(const std::function<void(const Record&)>& visit) const {
  for (const auto& [id, definition] : definitions_) visit(definition);
}

bool RecordReader::has_several_protocols() const {
  std::set<SharedText> protocols;
  for_each_definition([&](const Record& definition) { protocols.insert(definition.protocol); });
  return protocols.size() > 1;
}

void RecordReader::keep_scores(const std::function<bool(const Record&)>& is_kept) {
  kept_.clear();
  for (const auto& [id, definition] : definitions_) {
    if (is_kept(definition)) kept_ += (kept_.empty() ? "" : ",") + std::to_string(id);
  }
  kept_ = " AND definition IN (" + kept_ + ")";
}

void RecordReader::step_scores() { row_cell_ = scores_->step() ? scores_->integer() : 0; }

void RecordReader::add_cell(const StoredCell& cell, std::vector<Record>& out) {
  if (cell.scores == 0) {  // declined or failed
    set_cell(out.emplace_back(), cell);
    return;
  }
  // An incomplete cell can be complete at other times, so its scores have their own status.
  const bool is_incomplete = cell.status == Status::incomplete;
  const bool has_status = cell.status == Status::ok || is_incomplete;
  const bool has_reason = cell.why.empty() || is_incomplete;
  for (; row_cell_ == cell.id; step_scores()) {
    scores_->integer();  // number
    Record& r = out.emplace_back(definitions_.at(scores_->integer()));
    set_cell(r, cell);
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
      std::string("SELECT score_value.cell, ") + kScoreTable.columns +
      " FROM (SELECT id, position FROM cell WHERE position IS NOT NULL) CROSS JOIN score_value ON "
      "score_value.cell = id" +
      kept_ + " ORDER BY position, id, number"));
  step_scores();
  const std::vector<bool> is_end = ends_of_chunks(cells_);
  std::size_t next = 0;
  std::size_t size = 0;  // of the last chunk
  const auto read = [&] {
    std::vector<Record> out;
    out.reserve(size + size / 2);  // callers add derived records
    while (next < cells_.size()) {
      add_cell(cells_[next], out);
      if (is_end[next++] && out.size() >= kLeastRecords) break;
    }
    size = out.size();
    expand_failed_metrics(out, scores_anywhere_);
    return out;
  };
  // One chunk is read while the previous one is visited.
  std::future<std::vector<Record>> coming = std::async(std::launch::deferred, read);
  for (bool goes_on = next < cells_.size(); goes_on;) {
    std::vector<Record> records = coming.get();
    goes_on = next < cells_.size();
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
