/// Values of serialised rows.
#include "harness/store/row_bytes.hpp"

#include <gtest/gtest.h>

#include "harness/store/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::row_bytes_test {

using namespace harness;

namespace {

TEST(RowBytes, HoldWhatSqliteReturns) {
  const TemporaryFolder folder;
  Database database(folder.path() / "a.sqlite", Database::Mode::create);
  Statement row = database.prepare("SELECT 7, 2.5, 'text', x'0061ff', NULL, '', -1, 'last'");
  ASSERT_TRUE(row.step());
  const std::string bytes(row.bytes_of_columns(0, row.columns()));
  RowBytes read(bytes);
  EXPECT_EQ(read.integer(), 7);
  EXPECT_EQ(read.real(), 2.5);
  EXPECT_EQ(read.view(), "text");
  EXPECT_EQ(read.view(), std::string_view("\0a\xff", 3));
  EXPECT_TRUE(read.is_null());
  read.skip();
  EXPECT_FALSE(read.is_null());
  EXPECT_EQ(read.view(), "");
  EXPECT_EQ(read.real(), -1.0);
  EXPECT_FALSE(read.rest().empty());
  EXPECT_EQ(read.view(), "last");
  EXPECT_TRUE(read.rest().empty() && read.is_null());
  EXPECT_EQ(read.integer(), 0);
  EXPECT_EQ(read.view(), "");
}

TEST(RowBytes, GiveNothingForAnotherType) {
  const TemporaryFolder folder;
  Database database(folder.path() / "a.sqlite", Database::Mode::create);
  Statement row = database.prepare("SELECT 'text', 2.5, 7");
  ASSERT_TRUE(row.step());
  RowBytes read(row.bytes_of_columns(0, 3));
  EXPECT_EQ(read.integer(), 0);
  EXPECT_EQ(read.integer(), 0);
  EXPECT_EQ(read.view(), "");
}

}  // namespace
}  // namespace loopbench::row_bytes_test
