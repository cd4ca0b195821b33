/// The statements of a store find rows by index where a key is given.
#include <sqlite3.h>

#include <mutex>
#include <set>

#include "harness/store/merge.hpp"
#include "harness/store/read.hpp"
#include "harness/store/resume.hpp"
#include "harness/store/traces.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::query_plan_test {
namespace {

using namespace tiny_store;

std::mutex mutex;
std::set<std::string> statements;

int add_statement(unsigned, void*, void* statement, void*) {
  const char* sql = sqlite3_sql(static_cast<sqlite3_stmt*>(statement));
  const std::lock_guard<std::mutex> lock(mutex);
  if (sql != nullptr) statements.insert(sql);
  return 0;
}

/// Called for every database that is opened.
int trace_statements(sqlite3* database, char**, const struct sqlite3_api_routines*) {
  return sqlite3_trace_v2(database, SQLITE_TRACE_STMT, add_statement, nullptr);
}

using Extension = void (*)();

class QueryPlan : public TinyStore {
 protected:
  QueryPlan() { sqlite3_auto_extension(reinterpret_cast<Extension>(trace_statements)); }
  ~QueryPlan() override {
    sqlite3_cancel_auto_extension(reinterpret_cast<Extension>(trace_statements));
  }

  /// The tables that a statement reads completely, as SQLite explains them.
  std::string scans_of(sqlite3* database, const std::string& sql) {
    sqlite3_stmt* plan = nullptr;
    const std::string explain = "EXPLAIN QUERY PLAN " + sql;
    EXPECT_EQ(sqlite3_prepare_v2(database, explain.c_str(), -1, &plan, nullptr), SQLITE_OK)
        << sql << ": " << sqlite3_errmsg(database);
    std::string out;
    while (sqlite3_step(plan) == SQLITE_ROW) {
      const std::string detail(reinterpret_cast<const char*>(sqlite3_column_text(plan, 3)));
      if (detail.starts_with("SCAN ")) out += detail + "; ";
    }
    sqlite3_finalize(plan);
    return out;
  }
};

TEST_F(QueryPlan, NoTableIsScannedForOneKey) {
  run(kUsual);
  run(kUsual, Retry::all);
  run(config("straight, {method: shift, by: 2, label: shifted}"));
  read_records(file_);
  read_cells(file_);
  Traces traces(file_);
  EXPECT_TRUE(traces.cell(0) && traces.sequence(0));
  merge_stores({file_}, folder_.path() / "merged.sqlite");

  std::set<std::string> of_a_key;
  for (const std::string& sql : statements) {
    if (sql.find("= ?") != std::string::npos) of_a_key.insert(sql);
  }
  EXPECT_GT(of_a_key.size(), 25u);
  EXPECT_TRUE(of_a_key.contains("SELECT * FROM scores WHERE cell >= ? ORDER BY cell"));

  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
  const std::string attach = "ATTACH '" + file_.string() +
                             "' AS source; CREATE TEMP TABLE copied (id INTEGER PRIMARY KEY)";
  ASSERT_EQ(sqlite3_exec(database, attach.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  for (const std::string& sql : of_a_key) EXPECT_EQ(scans_of(database, sql), "") << sql;
  EXPECT_NE(scans_of(database, "SELECT * FROM cell WHERE method = ?"), "") << "has no index";
  sqlite3_close(database);
}

}  // namespace
}  // namespace loopbench::query_plan_test
