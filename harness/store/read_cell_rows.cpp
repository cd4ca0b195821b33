#include <cmath>
#include <future>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/store/cell_rows.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/row_bytes.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

template <class T>
std::optional<T> maybe(RowBytes& row, T (RowBytes::*read)()) {
  const bool none = row.is_null();
  const T value = (row.*read)();
  return none ? std::nullopt : std::optional<T>(value);
}

std::optional<Status> status_of(std::string_view text) {
  return from_text<Status>(std::string(text));
}

/// A text of a column; neighbouring cells mostly have the same.
class SharedColumn {
 public:
  const SharedText& read(RowBytes& row) {
    const std::string_view text = row.view();
    if (last_.text() != text) last_ = text;
    return last_;
  }

 private:
  SharedText last_;
};

/// All columns that tables need; `row` is at its first column.
CellRecord record_of(RowBytes row, WithRecords with) {
  CellRecord c;
  const auto text = [&]() -> SharedText {
    const std::string_view own = row.view();
    return with == WithRecords::yes ? SharedText(own) : SharedText();
  };
  row.skip();  // id
  c.position = row.integer();
  const std::string_view key = row.view();
  if (with == WithRecords::yes) c.key = key;
  c.build = text();
  row.skip();  // sequence_key
  row.skip();  // provenance_key
  c.sequence = row.view();
  c.repeat = row.integer();
  c.method = row.view();
  c.dataset_options = text();
  c.method_options = text();
  c.closures = row.view();
  c.oracle_closures = row.integer() != 0;
  c.oracle = row.integer() != 0;
  c.worker = row.view();
  c.runs = row.integer();
  c.seconds = row.real();
  c.seconds_min = row.real();
  c.seconds_max = row.real();
  c.cpu_seconds = maybe(row, &RowBytes::real);
  c.peak_memory = maybe(row, &RowBytes::integer);
  c.added_memory = maybe(row, &RowBytes::integer);
  c.allocations = maybe(row, &RowBytes::integer);
  c.status = status_of(row.view()).value_or(Status::failed);
  c.signal = text();
  c.why = text();
  return c;
}

/// Parses and checks rows of the table cell.
class RowReader {
 public:
  RowReader(CellRows& out, WithRecords with, SumOfDigests& sum)
      : out_(out), with_(with), sum_(sum) {}

  /// `bytes`: a row as serialised by Statement::bytes_of_columns().
  void add(std::string_view bytes) {
    RowBytes row(bytes);
    CellRow& cell = out_.cells.emplace_back();
    cell.id = row.integer();
    cell.placed = !row.is_null();
    cell.position = row.integer();
    cell.key = hash_of(row.view());
    row.skip();  // build
    cell.sequence_key = sequence_key_.read(row);
    row.skip();  // provenance_key
    cell.sequence = sequence_.read(row);
    cell.repeat = row.integer();
    cell.method = method_.read(row);
    row.skip();  // dataset_options
    row.skip();  // method_options
    cell.closures = closures_.read(row);
    cell.oracle_closures = row.integer() != 0;
    cell.oracle = row.integer() != 0;
    row.skip();  // worker
    const bool is_timed = row.integer() > 0;
    cell.seconds = row.real();
    for (int i = 0; i < 6; ++i) row.skip();  // seconds_min to allocations
    const std::optional<Status> status = status_of(row.view());
    cell.status = status.value_or(Status::failed);
    if (!is_timed && has_numbers(cell.status)) cell.seconds = std::nan("");
    row.skip();  // signal
    cell.why = why_.read(row);
    cell.failed_scores = row.integer();
    for (Hash& digest : cell.details) digest = parsed_digest(row.view());
    RowsDigest all;
    all.add(bytes.substr(0, bytes.size() - row.rest().size()));
    cell.digest = parsed_digest(row.view());
    cell.intact = status && all.value() == cell.digest;
    sum_.add(cell.digest);
    if (with_ != WithRecords::no) out_.records.push_back(record_of(RowBytes(bytes), with_));
  }

 private:
  CellRows& out_;
  WithRecords with_;
  SumOfDigests& sum_;  ///< of all rows, see written_digest()
  SharedColumn sequence_key_;
  SharedColumn sequence_;
  SharedColumn method_;
  SharedColumn closures_;
  SharedColumn why_;
};

/// Some rows of the table cell.
struct PartOfCells {
  CellRows rows;
  SumOfDigests sum;
};

/// The rows with begin <= id <= end.
PartOfCells read_part(Database& database, WithRecords with, std::int64_t begin, std::int64_t end) {
  PartOfCells out;
  RowReader reader(out.rows, with, out.sum);
  Statement rows =
      database.prepare("SELECT * FROM cell NOT INDEXED WHERE id >= ? AND id <= ? ORDER BY id");
  rows.bind(begin).bind(end);
  while (rows.step()) reader.add(rows.bytes_of_columns(0, rows.columns()));
  return out;
}

template <class T>
void append(std::vector<T>& out, std::vector<T>&& more) {
  out.insert(out.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

/// All rows, half of them through a second connection on another thread. That connection can see
/// another state of the store, which the sum of digests shows: then the result is not complete.
PartOfCells read_halves(Database& database,
                        WithRecords with,
                        std::int64_t least,
                        std::int64_t largest) {
  const std::int64_t middle = std::midpoint(least, largest);
  std::future<PartOfCells> upper = std::async(std::launch::async, [&] {
    try {
      Database other(database.file(), Database::Mode::read);
      return read_part(other, with, middle + 1, largest);
    } catch (const InputError&) {
      return PartOfCells{};  // an error of the store is met by the first connection, too
    }
  });
  PartOfCells out = read_part(database, with, least, middle);
  PartOfCells more = upper.get();
  append(out.rows.cells, std::move(more.rows.cells));
  append(out.rows.records, std::move(more.rows.records));
  out.sum.add(more.sum);
  return out;
}

}  // namespace

CellRows read_cell_rows(Database& database, WithRecords with) {
  const std::string digest = written_digest(database, "cell");
  const auto checked = [&](PartOfCells&& all) {
    all.rows.complete = all.sum.text() == digest;
    return std::move(all.rows);
  };
  Statement ids = database.prepare(
      "SELECT (SELECT min(id) FROM cell NOT INDEXED), (SELECT max(id) FROM cell NOT INDEXED)");
  if (!database.has_changed() && ids.step()) {
    const std::int64_t least = ids.integer();
    const std::int64_t largest = ids.integer();
    if (largest / 2 - least / 2 > kCellsWorthAThread / 2) {
      CellRows halves = checked(read_halves(database, with, least, largest));
      if (halves.complete) return halves;
    }
  }
  using Id = std::numeric_limits<std::int64_t>;
  return checked(read_part(database, with, Id::min(), Id::max()));
}

}  // namespace loopbench::harness
