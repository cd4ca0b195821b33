#include "harness/store/record_reader.hpp"

#include <algorithm>
#include <future>
#include <unordered_map>

#include "harness/store/open.hpp"
#include "harness/store/recorded_contents.hpp"

namespace loopbench::harness {
namespace {

constexpr int kFewRows = 32;  ///< rows that are passed over faster than a search
const std::size_t kScores = detail_number("score_value");

constexpr std::size_t kLeastRecords = 4096;  ///< of a chunk, so that a thread is worth it

/// Sets the common fields of all records of a cell.
void set_cell(Record& r, const CellRow& cell) {
  r.cell = cell.position;
  r.sequence = cell.sequence;
  r.repeat = cell.repeat;
  r.method = cell.method;
  r.closures = cell.closures;
  r.oracle_closures = cell.oracle_closures;
  r.oracle = cell.oracle;
  r.milliseconds = cell.seconds * 1000;
  r.status = cell.status;
  r.why = cell.why;
}

/// A score without relation: its metric failed or was declined completely.
bool can_be_failed_metric(const Record& d) { return !d.metric.empty() && d.relation.empty(); }

/// For each position in `order`, whether every sequence that began up to there has ended.
std::vector<bool> ends_of_chunks(const CellRows& rows, const std::vector<std::size_t>& order) {
  const auto sequence = [&](std::size_t i) { return rows.cells[order[i]].sequence.id(); };
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
    : file_(store_file(file)),
      database_(open_store(file)),
      rows_(read_cell_rows(database_)),
      sequences_(read_sequence_rows(database_)),
      definitions_(database_) {
  if (!rows_.complete || std::ranges::count(rows_.cells, false, &CellRow::intact) > 0) {
    check_scores(database_, definitions_, rows_);
    require_intact(rows_, file_);
  }
  require_intact(sequences_, file_);
  order_ = in_order(rows_);
  join_recorded_contents(database_, rows_, order_, sequences_);
  can_fail_ = std::ranges::any_of(definitions_.all(), [](const auto& entry) {
    return can_be_failed_metric(entry.second.record);
  });
  if (can_fail_) find_scores();
}

/// Adds the scores of all metrics to `failed_metrics_`, in order of first appearance.
void RecordReader::find_scores() {
  Statement row = database_.prepare(
      "SELECT v.definition FROM score_value v JOIN cell c ON c.id = v.cell WHERE c.position IS NOT "
      "NULL GROUP BY v.definition ORDER BY min(c.position), min(v.number)");
  while (row.step()) {
    const ScoreDefinition* definition = definitions_.find(row.integer());
    if (definition != nullptr) failed_metrics_.add(definition->record);
  }
}

void RecordReader::for_each_definition(const std::function<void(const Record&)>& visit) const {
  for (const auto& [id, definition] : definitions_.all()) visit(definition.record);
}

bool RecordReader::has_several_protocols() const {
  std::set<SharedText> protocols;
  for_each_definition([&](const Record& definition) { protocols.insert(definition.protocol); });
  return protocols.size() > 1;
}

void RecordReader::fail(const CellRow& cell) {
  check_scores(database_, definitions_, rows_);
  require_intact(rows_, file_);
  throw_damaged(file_, label_of(cell) + " is");
}

void RecordReader::keep_scores(const std::function<bool(const Record&)>& is_kept) {
  left_out_.clear();
  for (const auto& [id, definition] : definitions_.all()) {
    if (!is_kept(definition.record)) left_out_.insert(id);
  }
}

void RecordReader::set_run(const SharedText& sequence_key) {
  if (run_ == sequence_key) return;
  run_ = sequence_key;
  const auto found = sequences_.by_key.find(sequence_key);
  content_ = found == sequences_.by_key.end() ? "" : found->second.content;
  group_ = found == sequences_.by_key.end() ? "" : found->second.group;
}

/// Advances to the first score of the cell or of a later one.
void RecordReader::seek_scores(const CellRow& cell) {
  // Cells are mostly in the order in which they were written.
  for (int i = 0; has_row_ && row_cell_ < cell.id && i < kFewRows; ++i) step_scores();
  if (has_row_ && row_cell_ == cell.id) return;
  scores_->reset();
  scores_->bind(cell.id);
  step_scores();
}

void RecordReader::step_scores() {
  has_row_ = scores_->step();
  row_cell_ = has_row_ ? scores_->integer() : 0;
}

void RecordReader::add_cell(std::size_t index, std::vector<Record>& out) {
  const CellRow& cell = rows_.cells[index];
  set_run(cell.sequence_key);
  const auto add = [&](const Record& definition) -> Record& {
    Record& r = out.emplace_back(definition);
    set_cell(r, cell);
    r.content = content_;
    r.group = group_;
    return r;
  };
  const bool has_scores = cell.details[kScores] != Hash{};
  if (!has_scores) add({});  // a declined or failed cell
  seek_scores(cell);
  // An incomplete cell can be complete at other times, so its scores have their own status.
  const bool is_incomplete = cell.status == Status::incomplete;
  const bool has_status = cell.status == Status::ok || is_incomplete;
  const bool has_reason = cell.why.empty() || is_incomplete;
  ScoresDigest digest;
  for (; has_row_ && row_cell_ == cell.id; step_scores()) {
    scores_->integer();  // number
    const std::int64_t id = scores_->integer();
    const ScoreDefinition* const definition = definitions_.find(id);
    digest.add(*scores_, definition);
    if (definition == nullptr) fail(cell);
    if (!left_out_.empty() && left_out_.contains(id)) continue;
    Record& r = add(definition->record);
    if (!read_score(*scores_, r)) fail(cell);
    if (!has_status) r.status = cell.status;
    if (!has_reason) r.why = cell.why;
  }
  if (digest.value() != cell.details[kScores]) fail(cell);
}

void RecordReader::for_each_chunk(const std::function<bool(std::vector<Record>&)>& visit) {
  scores_.emplace(database_.prepare(std::string("SELECT ") + kScoreColumns +
                                    " FROM score_value WHERE cell >= ? ORDER BY cell, number"));
  has_row_ = false;
  const std::vector<bool> is_end = ends_of_chunks(rows_, order_);
  std::size_t next = 0;
  std::size_t size = 0;  // of the last chunk
  const auto read = [&] {
    std::vector<Record> out;
    out.reserve(size + size / 2);  // callers add derived records
    while (next < order_.size()) {
      add_cell(order_[next], out);
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
