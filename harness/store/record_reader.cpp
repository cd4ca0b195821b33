#include "harness/store/record_reader.hpp"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "harness/store/digest.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kScoresOfCell = "SELECT * FROM scores WHERE cell = ?";

/// The common fields of all records of a cell.
Record common_fields(const CellRow& cell) {
  Record r;
  r.cell = cell.position;
  r.sequence = *cell.sequence;
  r.repeat = cell.repeat;
  r.method = *cell.method;
  r.closures = *cell.closures;
  r.oracle_closures = cell.oracle_closures;
  r.oracle = cell.oracle;
  r.milliseconds = cell.seconds * 1000;
  r.status = *cell.status;
  r.why = *cell.why;
  return r;
}

void set_definition(Record& r, const ScoreDefinition& d) {
  r.protocol = d.protocol;
  r.protocol_version = d.protocol_version;
  r.times = d.times;
  r.metric = d.metric;
  r.label = d.label;
  r.relation = d.relation;
  r.axis = d.axis;
  r.unit = d.unit;
  r.better = from_text<metrics::Better>(d.better).value_or(metrics::Better::neither);
  r.target = d.target;
}

/// A score without relation: its metric failed or was declined completely.
bool can_be_failed_metric(const ScoreDefinition& d) {
  return !d.metric.empty() && d.relation.empty();
}

/// For each position in `order`, whether every sequence that began up to there has ended.
std::vector<bool> ends_of_chunks(const CellRows& rows, const std::vector<std::size_t>& order) {
  std::unordered_map<const std::string*, std::size_t> last;
  for (std::size_t i = 0; i < order.size(); ++i) last[rows.cells[order[i]].sequence] = i;
  std::vector<bool> out(order.size(), false);
  std::size_t end = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    end = std::max(end, last.at(rows.cells[order[i]].sequence));
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
      lists_(database_) {
  if (!rows_.complete || std::ranges::count(rows_.cells, false, &CellRow::intact) > 0) {
    check_scores(database_, lists_, rows_);
    require_intact(rows_, file_);
  }
  require_intact(sequences_, file_);
  order_ = in_order(rows_);
  const bool can_fail = std::ranges::any_of(lists_.all(), [](const auto& entry) {
    return std::ranges::any_of(entry.second, can_be_failed_metric);
  });
  if (can_fail) find_scores();
}

/// Adds the scores of all metrics to `failed_metrics_`, in order of first appearance.
void RecordReader::find_scores() {
  Statement row = database_.prepare("SELECT list FROM scores WHERE cell = ?");
  std::set<std::string> seen;
  for (const std::size_t cell : order_) {
    row.bind(rows_.cells[cell].id);
    if (row.step()) {
      const std::string key = row.text();
      const ScoreList* list = seen.insert(key).second ? lists_.find(key) : nullptr;
      if (list != nullptr) {
        for (const ScoreDefinition& definition : *list) {
          Record record;
          set_definition(record, definition);
          failed_metrics_.add(record);
        }
      }
    }
    row.reset();
  }
}

bool RecordReader::has_several_protocols() const {
  std::set<std::string> protocols;
  for (const auto& [key, list] : lists_.all()) {
    for (const ScoreDefinition& definition : list) protocols.insert(definition.protocol);
  }
  return protocols.size() > 1;
}

void RecordReader::fail(const CellRow& cell) {
  check_scores(database_, lists_, rows_);
  require_intact(rows_, file_);
  throw_damaged(file_, label_of(cell) + " is");
}

void RecordReader::add_cell(std::size_t index, Statement& scores, std::vector<Record>& out) {
  const CellRow& cell = rows_.cells[index];
  Record common = common_fields(cell);
  const auto sequence = sequences_.by_key.find(*cell.sequence_key);
  if (sequence != sequences_.by_key.end()) {
    common.content = sequence->second.content;
    common.group = sequence->second.group;
  }
  scores.bind(cell.id);
  const bool has_scores = scores.step();
  const Hash digest = has_scores ? digest_of_row(scores, 1, scores.columns()) : Hash{};
  if (digest != cell.details[detail_number("scores")]) fail(cell);
  if (!has_scores) {  // a declined or failed cell has none
    scores.reset();
    out.push_back(std::move(common));
    return;
  }
  scores.skip();  // cell
  if (!is_complete(lists_, scores)) fail(cell);
  scores.rewind();
  scores.skip();
  const ScoreList& list = *lists_.find(scores.view());
  const std::string_view numbers = scores.view();
  const std::string_view statuses = scores.view();
  const std::vector<std::string> own = split_statuses(statuses, list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    Record& r = out.emplace_back(common);
    set_definition(r, list[i]);
    const ScoreNumbers values = unpacked(numbers, i);
    r.statistics = values.statistics;
    r.pairs = values.pairs;
    r.possible = values.possible;
    // An incomplete cell can be complete at other times, so its scores have their own status.
    const bool is_incomplete = common.status == "incomplete";
    if (common.status == "ok" || is_incomplete) r.status = own[2 * i];
    if (common.why.empty() || is_incomplete) r.why = own[2 * i + 1];
  }
  scores.reset();
}

void RecordReader::for_each_chunk(const std::function<bool(std::vector<Record>&)>& visit) {
  Statement scores = database_.prepare(kScoresOfCell);
  const std::vector<bool> is_end = ends_of_chunks(rows_, order_);
  std::vector<Record> records;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    add_cell(order_[i], scores, records);
    if (!is_end[i]) continue;
    failed_metrics_.expand(records);
    if (!visit(records)) return;
    records.clear();
  }
}

}  // namespace loopbench::harness
