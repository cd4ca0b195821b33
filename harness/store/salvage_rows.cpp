#include "harness/store/salvage_rows.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/store/digest.hpp"
#include "harness/store/page_rows.hpp"

namespace loopbench::harness {
namespace {

using Type = PageValue::Type;

/// A table of the schema, by which rows are recognised.
class TableShape {
 public:
  TableShape(Database& database, std::string name, bool has_rowid)
      : name_(std::move(name)), has_rowid_(has_rowid) {
    Statement columns =
        database.prepare("SELECT name, type, \"notnull\", pk FROM pragma_table_info(?)");
    columns.bind(name_);
    while (columns.step()) {
      Column& column = columns_.emplace_back();
      column.name = columns.text();
      column.type = columns.text();
      column.required = columns.integer() != 0;
      column.is_rowid = columns.integer() != 0 && has_rowid_ && column.type == "INTEGER";
    }
  }

  const std::string& name() const { return name_; }

  bool fits(const PageRow& row) const {
    return row.has_rowid == has_rowid_ &&
           std::ranges::equal(row.values, columns_, [](const PageValue& value, const Column& c) {
             if (c.is_rowid) return value.type == Type::null;  // stored as the rowid
             switch (value.type) {
               case Type::null:
                 return !c.required;
               case Type::integer:
                 return c.type == "INTEGER" || c.type == "REAL";
               case Type::real:
                 return c.type == "REAL";
               case Type::text:
                 return c.type == "TEXT";
               case Type::blob:
                 return c.type == "BLOB";
             }
             return false;
           });
  }

  Statement insertion(Database& database) const {
    std::string names = has_rowid_ ? "rowid" : "";
    std::string values = has_rowid_ ? "?" : "";
    for (const Column& column : columns_) {
      if (column.is_rowid) continue;
      names += (names.empty() ? "\"" : ", \"") + column.name + "\"";
      values += values.empty() ? "?" : ",?";
    }
    return database.prepare("INSERT OR IGNORE INTO \"" + name_ + "\" (" + names + ") VALUES (" +
                            values + ")");
  }

  void insert(Statement& insertion, const PageRow& row) const {
    if (has_rowid_) insertion.bind(row.rowid);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const PageValue& value = row.values[i];
      if (columns_[i].is_rowid) continue;
      switch (value.type) {
        case Type::null:
          insertion.bind_null();
          break;
        case Type::integer:
          insertion.bind(value.integer);
          break;
        case Type::real:
          insertion.bind(value.real);
          break;
        case Type::text:
          insertion.bind(std::string(value.bytes));
          break;
        case Type::blob:
          insertion.bind_blob(value.bytes);
          break;
      }
    }
    insertion.run();
  }

 private:
  struct Column {
    std::string name;
    std::string type;
    bool required = false;
    bool is_rowid = false;
  };
  std::string name_;
  bool has_rowid_;
  std::vector<Column> columns_;
};

/// Tables `phase` and `count` have the same columns; the digests of cells tell which of them a page
/// belongs to.
class PhasesAndCounts {
 public:
  explicit PhasesAndCounts(Database& database) : database_(database) {
    database_.execute(
        "CREATE TEMP TABLE either (page, number, cell INTEGER, name TEXT, value REAL)");
    insert_.emplace(database_.prepare("INSERT INTO either VALUES (?,?,?,?,?)"));
  }

  void add(const PageRow& row) {
    insert_->bind(std::int64_t{row.page}).bind(row.rowid).bind(row.values[0].integer);
    if (row.values[1].type == Type::null) {
      insert_->bind_null();
    } else {
      insert_->bind(std::string(row.values[1].bytes));
    }
    switch (row.values[2].type) {
      case Type::integer:
        insert_->bind(row.values[2].integer);
        break;
      case Type::real:
        insert_->bind(row.values[2].real);
        break;
      default:
        insert_->bind_null();
    }
    insert_->run();
  }

  /// Writes the rows of all pages that can be assigned to a table. Call once.
  void assign() {
    read();
    while (assign_some()) {
    }
    for (const auto& [page, table] : table_of_) {
      database_
          .prepare("INSERT OR IGNORE INTO \"" + table + "\" (rowid, cell, name, " +
                   (table == "phase" ? "seconds" : "value") +
                   ") SELECT number, cell, name, value FROM either WHERE page = ?")
          .bind(page)
          .run();
    }
    insert_.reset();
    database_.execute("DROP TABLE either");
  }

 private:
  using Page = std::int64_t;
  struct OneCell {
    std::map<std::string, std::string> digests;                   ///< by table
    std::map<Page, std::map<std::int64_t, std::string>> by_page;  ///< rows by rowid, serialised
  };

  void read() {
    Statement digests = database_.prepare("SELECT id, phase_digest, count_digest FROM cell");
    while (digests.step()) {
      OneCell& cell = cells_[digests.integer()];
      cell.digests["phase"] = digests.text();
      cell.digests["count"] = digests.text();
    }
    Statement rows = database_.prepare("SELECT cell, name, value, page, number FROM either");
    while (rows.step()) {
      const std::string bytes(rows.bytes_of_columns(1, 3));
      const auto found = cells_.find(rows.integer());
      rows.text();
      rows.real();
      const Page page = rows.integer();
      if (found != cells_.end()) found->second.by_page[page][rows.integer()] = bytes;
    }
  }

  /// Finds cells whose rows, on one page or on all that are left, match a digest.
  bool assign_some() {
    const std::size_t before = table_of_.size();
    for (const auto& [id, cell] : cells_) {
      std::set<Page> left;
      for (const auto& [page, rows] : cell.by_page) {
        if (!table_of_.contains(page)) left.insert(page);
      }
      std::vector<std::set<Page>> sets;
      for (const Page page : left) sets.push_back({page});
      if (left.size() > 1) sets.push_back(left);
      for (const std::set<Page>& pages : sets) {
        for (const char* table : {"phase", "count"}) {
          if (digest_of(cell, pages, table) != cell.digests.at(table)) continue;
          for (const Page page : pages) table_of_.emplace(page, table);
        }
      }
    }
    return table_of_.size() > before;
  }

  /// Of the rows on `pages` and on those known to belong to `table`.
  std::string digest_of(const OneCell& cell,
                        const std::set<Page>& pages,
                        const std::string& table) const {
    std::map<std::int64_t, std::string> rows;
    for (const auto& [page, some] : cell.by_page) {
      const auto known = table_of_.find(page);
      if (pages.contains(page) || (known != table_of_.end() && known->second == table)) {
        rows.insert(some.begin(), some.end());
      }
    }
    RowsDigest digest;
    for (const auto& [number, bytes] : rows) digest.add(bytes);
    return digest.text();
  }

  Database& database_;
  std::optional<Statement> insert_;
  std::map<std::int64_t, OneCell> cells_;
  std::map<Page, std::string> table_of_;
};

}  // namespace

void insert_rows(Database& database, const PageFile& file, const PageView& view) {
  std::vector<std::pair<TableShape, Statement>> tables;
  Statement names = database.prepare(
      "SELECT name, wr FROM pragma_table_list WHERE schema = 'main' AND type = 'table' AND name "
      "NOT "
      "LIKE 'sqlite_%' AND name NOT IN ('phase', 'count') ORDER BY name");
  while (names.step()) {
    std::string name = names.text();
    TableShape shape(database, std::move(name), names.integer() == 0);
    Statement insertion = shape.insertion(database);
    tables.emplace_back(std::move(shape), std::move(insertion));
  }
  names.reset();
  const TableShape either(database, "phase", true);
  PhasesAndCounts phases_and_counts(database);
  const auto is_digest = [](const PageRow& row) {
    const std::string_view key = row.values[0].bytes;
    return key == "run" || key == "provenance" || key == "cell" || key == "sequence";
  };
  for_each_row(file, view, [&](const PageRow& row) {
    if (either.fits(row)) return phases_and_counts.add(row);
    for (auto& [shape, insertion] : tables) {
      if (!shape.fits(row)) continue;
      // Tables `run` and `digest` have the same columns.
      if ((shape.name() == "run" && is_digest(row)) ||
          (shape.name() == "digest" && !is_digest(row))) {
        continue;
      }
      return shape.insert(insertion, row);
    }
  });
  phases_and_counts.assign();
}

}  // namespace loopbench::harness
