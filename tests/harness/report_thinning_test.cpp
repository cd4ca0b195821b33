/// How many points and repeats a report draws.
#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "harness/report/data.hpp"
#include "harness/report/report.hpp"
#include "tests/studies/synthetic_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::harness {
namespace {

TEST(Thinning, TakesPointsThenRepeatsThenPoints) {
  Thinning thinning{400, 5};
  EXPECT_TRUE(reduce(thinning, 0.5));
  EXPECT_EQ(thinning.points, 200u);
  EXPECT_TRUE(reduce(thinning, 0.1));
  EXPECT_EQ(thinning.points, 100u);
  EXPECT_TRUE(reduce(thinning, 0.9));
  EXPECT_EQ(thinning.repeats, 3u);
  EXPECT_TRUE(reduce(thinning, 0.9) && reduce(thinning, 0.9));
  EXPECT_EQ(thinning.repeats, 1u);
  EXPECT_TRUE(reduce(thinning, 0.99));
  EXPECT_EQ(thinning.points, 99u);
  EXPECT_TRUE(reduce(thinning, 0.0));
  EXPECT_EQ(thinning.points, 10u);
  EXPECT_FALSE(reduce(thinning, 0.5));
}

/// Ten sequences of 40 methods.
TEST(Report, LeavesOutSequencesThatDoNotFit) {
  std::vector<Record> records;
  for (int i = 0; i < 400; ++i) {
    Record& r = records.emplace_back();
    r.cell = i;
    r.sequence = "sequence " + std::to_string(i / 40);
    r.method = "m" + std::to_string(i % 40);
    r.protocol = "p";
    r.times = "dense";
    r.metric = "ate";
    r.relation = "translation";
    r.axis = "3d";
    r.unit = "m";
    r.statistics.rmse = r.statistics.mean = 1.0 + i % 40;
  }
  const TemporaryFolder folder;
  synthetic::write_store(records, folder.path());
  const ReportContent content = read_report_content(folder.path());
  EXPECT_EQ(content.shown, 10u);
  const std::string whole = report_html(content);
  EXPECT_EQ(whole.find("sequences, because"), std::string::npos);

  const std::string part = report_html(content, whole.size() - 1000);
  EXPECT_LT(part.size(), whole.size() - 1000);
  EXPECT_NE(part.find("show the first 9 of 10 sequences"), std::string::npos);
  EXPECT_NE(part.find("data-sequence=\"sequence 8\""), std::string::npos);
  EXPECT_EQ(part.find("data-sequence=\"sequence 9\""), std::string::npos);
  EXPECT_NE(part.find("over 10 "), std::string::npos) << "verdicts cover all";

  const ReportContent little = read_report_content(folder.path(), 1000);
  EXPECT_EQ(little.shown, 3u);  // 100 records of 40 each
  EXPECT_EQ(little.shown_cells.size(), 120u);
  EXPECT_EQ(little.cells.size(), 400u);
  EXPECT_THROW(report_html(content, 1000), InputError);
}

}  // namespace
}  // namespace loopbench::harness
