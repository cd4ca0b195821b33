#include "harness/store/record_reader.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <set>
#include <unordered_map>

#include "harness/store/open.hpp"
#include "harness/store/recorded_contents.hpp"

namespace loopbench::harness {
namespace {

constexpr int kFewRows = 64;  ///< rows that are passed over faster than a search

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
  r.status = cell.status;
  r.why = cell.why;
}

std::map<std::int64_t, Record> read_definitions(Database& database) {
  std::map<std::int64_t, Record> out;
  Statement row = database.prepare(
      "SELECT id, protocol, protocol_version, times, metric, label, relation, axis, unit, better, "
      "target FROM score_definition ORDER BY id");
  while (row.step()) {
    Record& r = out[row.integer()];
    r.protocol = row.text();
    r.protocol_version = row.text();
    r.times = row.text();
    r.metric = row.text();
    r.label = row.text();
    r.relation = row.text();
    r.axis = row.text();
    r.unit = row.text();
    r.better = from_text<metrics::Better>(row.text()).value_or(metrics::Better::neither);
    r.target = row.real();
  }
  return out;
}

/// A score without relation: its metric failed or was declined completely.
bool can_be_failed_metric(const Record& definition) {
  return !definition.metric.empty() && definition.relation.empty();
}

/// For each position in `order`, whether every sequence that began up to there has ended.
std::vector<bool> ends_of_chunks(const std::vector<StoredCell>& cells,
                                 const std::vector<std::size_t>& order) {
  const auto sequence = [&](std::size_t i) { return cells[order[i]].sequence.id(); };
  const auto begins = [&](std::size_t i) { return i == 0 || sequence(i) != sequence(i - 1); };
  std::unordered_map<const void*, std::size_t> last;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i + 1 == order.size() || begins(i + 1)) last[sequence(i)] = i;
  }
  std::vector<bool> out(order.size(), false);
  std::size_t end = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (begins(i)) end = std::max(end, last.at(sequence(i)));
    out[i] = i == end;
  }
  return out;
}

}  // namespace

RecordReader::RecordReader(const std::filesystem::path& file)
    : database_(open_store(file)),
      cells_(read_cell_rows(database_)),
      sequences_(read_sequence_rows(database_)),
      definitions_(read_definitions(database_)) {
  check_scores(database_, cells_);
  require_intact(database_, cells_);
  order_ = in_order(cells_);
  join_recorded_contents(database_, cells_, order_, sequences_);
  can_fail_ = std::ranges::any_of(
      definitions_, [](const auto& entry) { return can_be_failed_metric(entry.second); });
  if (can_fail_) find_scores();
}

/// Adds the scores of all metrics to `failed_metrics_`, in order of first appearance.
void RecordReader::find_scores() {
  Statement row = database_.prepare(
      "SELECT definition, min(position << 20 | number) AS first FROM score_value JOIN cell ON "
      "cell.id = cell WHERE position IS NOT NULL GROUP BY definition ORDER BY first");
  while (row.step()) {
    const auto found = definitions_.find(row.integer());
    if (found != definitions_.end()) failed_metrics_.add(found->second);
  }
}

void RecordReader::for_each_definition(const std::function<void(const Record&)>& visit) const {
  for (const auto& [id, definition] : definitions_) visit(definition);
}

bool RecordReader::has_several_protocols() const {
  std::set<std::string> protocols;
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

void RecordReader::step_scores() {
  has_row_ = scores_->step();
  row_cell_ = has_row_ ? scores_->integer() : 0;
}

void RecordReader::add_cell(const StoredCell& cell, std::vector<Record>& out) {
  const auto sequence = sequences_.find(cell.sequence_key);
  const auto add = [&](const Record& definition) -> Record& {
    Record& r = out.emplace_back(definition);
    set_cell(r, cell);
    if (sequence != sequences_.end()) {
      r.content = sequence->second.content;
      r.group = sequence->second.group;
    }
    return r;
  };
  if (cell.score_count == 0) {  // declined or failed
    add({});
    return;
  }
  // Cells are mostly in the order in which they were written.
  for (int i = 0; has_row_ && row_cell_ < cell.id && i < kFewRows; ++i) step_scores();
  if (!has_row_ || row_cell_ != cell.id) {
    scores_->reset();
    scores_->bind(cell.id);
    step_scores();
  }
  // An incomplete cell can be complete at other times, so its scores have their own status.
  const bool is_incomplete = cell.status == Status::incomplete;
  const bool has_status = cell.status == Status::ok || is_incomplete;
  const bool has_reason = cell.why.empty() || is_incomplete;
  for (; has_row_ && row_cell_ == cell.id; step_scores()) {
    Record& r = add(definitions_.at(scores_->integer()));
    scores_->integer();  // number
    metrics::Statistics& s = r.statistics;
    s.count = static_cast<std::size_t>(scores_->integer());
    for (double* value : {&s.rmse, &s.mean, &s.median, &s.std, &s.min, &s.max, &s.sse}) {
      *value = scores_->real();
    }
    r.pairs = scores_->integer();
    r.possible = scores_->integer();
    r.span = scores_->real();
    const std::string status = scores_->text();
    if (has_status) r.status = from_text<Status>(status).value_or(Status::failed);
    if (has_reason) r.why = scores_->text();
  }
}

void RecordReader::for_each_chunk(const std::function<bool(std::vector<Record>&)>& visit) {
  scores_.emplace(database_.prepare(std::string("SELECT ") + kScoreColumns +
                                    " FROM score_value WHERE cell >= ?" + kept_ +
                                    " ORDER BY cell, number"));
  has_row_ = false;
  const std::vector<bool> is_end = ends_of_chunks(cells_, order_);
  std::size_t next = 0;
  std::size_t size = 0;  // of the last chunk
  const auto read = [&] {
    std::vector<Record> out;
    out.reserve(size + size / 2);  // callers add derived records
    while (next < order_.size()) {
      add_cell(cells_[order_[next]], out);
      if (is_end[next++] && out.size() >= kLeastRecords) break;
    }
    size = out.size();
    if (can_fail_) failed_metrics_.expand(out);
    return out;
  };
  // One chunk is read while the previous one is visited.
  std::future<std::vector<Record>> coming = std::async(std::launch::deferred, read);
  for (bool goes_on = next < order_.size(); goes_on;) {
    std::vector<Record> records = coming.get();
    goes_on = next < order_.size();
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
