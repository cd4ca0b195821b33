/// What a metric states for each pose, from the cell to the report.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/answers/report/data.hpp"
#include "harness/sweep/store/traces.hpp"
#include "tests/support/command.hpp"

namespace loopbench::pose_values_test {

using namespace harness;

namespace {

TEST(PoseValues, OfAProgramReachTheReport) {
  const TemporaryFolder folder;
  folder.file("height.sh", R"(
awk '{ values = values (NR > 1 ? ", " : "") $4 }
     END { printf "{\"scores\": [{\"name\": \"top\", \"unit\": \"m\", \"values\": [%s]}]}", values }' \
  "$1/estimate.txt" >"$2"
)");
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, path: room, keyframes: 40}]\nmethods: [raw]\n"
              "metrics: [ate, {metric: command, label: height, run: \"sh height.sh {evaluation} "
              "{result}\"}]\n");
  const CommandResult ran = loopbench_command("run c.yaml --out r -j 1", folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  Traces traces(folder.path() / "r");
  const auto trace = traces.cell(0);
  const auto sequence = traces.sequence(0);
  ASSERT_TRUE(trace && sequence);
  ASSERT_EQ(trace->values.size(), 1u);
  EXPECT_EQ(trace->values[0].name, "height top");
  EXPECT_EQ(trace->values[0].unit, "m");
  ASSERT_EQ(trace->values[0].values.size(), trace->samples.size());
  const auto [low, high] = std::ranges::minmax(trace->values[0].values);
  const double rounding = 2 * (high - low) / (2 * kDrawnSteps);  // of the value and of the height
  for (std::size_t i = 0; i < trace->samples.size(); ++i) {
    const double height = sequence->origin.z + trace->samples[i].estimate.z;
    EXPECT_NEAR(trace->values[0].values[i], height, rounding + 1e-5);
  }
  const nlohmann::json drawn =
      traces_json(read_report_content(folder.path() / "r"), {})["cells"]["0"]["values"];
  ASSERT_EQ(drawn.size(), 1u);
  EXPECT_EQ(drawn[0]["name"], "height top");
}

}  // namespace
}  // namespace loopbench::pose_values_test
