// Success rates over runs.
#include "harness/answers/tables/success.hpp"

#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::success_test {
namespace {

std::vector<std::string> texts(const std::vector<TableCell>& line) {
  std::vector<std::string> out;
  for (const TableCell& cell : line) out.push_back(cell.text);
  return out;
}

using Line = std::vector<std::string>;

TEST(Success, CountsFailedRunsAsFailures) {
  std::vector<Record> records;
  const auto add = [&](const char* method, double error) -> Record& {
    const auto cell = static_cast<int>(records.size());
    Record& r = records.emplace_back(ate(method, error, cell));
    r.cell.edit().position = cell;
    r.kind.edit().unit = "m";
    return r;
  };
  for (int run = 0; run < 8; ++run) add("slam", 0.1);
  add("slam", 0.5);
  Record& failed = add("slam", 0.0);
  failed.kind.edit().metric = failed.kind.edit().relation = failed.kind.edit().axis = "";
  failed.status = Status::failed;
  add("other", 0.05).status = Status::incomplete;
  Record& declined = add("third", 0.0);
  declined.kind.edit().metric = "";
  declined.status = Status::declined;
  const Table table = success_table(records, "rmse", 0.1);
  ASSERT_EQ(table.lines.size(), 2u);
  // Wilson: (0.8 + 0.1921 +- 1.96 sqrt(0.016 + 0.0096)) / 1.3841.
  EXPECT_EQ(texts(table.lines[0]), (Line{"slam", "10", "8", "80.0", "49.0 to 94.3"}));
  EXPECT_EQ(texts(table.lines[1]), (Line{"other", "1", "0", "0.0", "0.0 to 79.3"}));
  records.front().kind.edit().better = Better::higher;
  EXPECT_EQ(texts(success_table({records.front()}, "rmse", 0.2).lines[0])[2], "0");
}

TEST(Success, NeedsAScoreAndAStatistic) {
  EXPECT_THROW(success_table({}, "rmse", 1.0), InputError);
  EXPECT_THROW(success_table({ate("a", 1.0, 0)}, "p42", 1.0), InputError);
}

}  // namespace
}  // namespace loopbench::compared_sweep::success_test
