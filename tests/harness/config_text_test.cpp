/// Interpretation of scalars depends on the option's type.
#include <gtest/gtest.h>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::config_text_test {

using namespace harness;

namespace {

std::string config(const std::string& datasets,
                   const std::string& metrics = "ate",
                   const std::string& rest = "") {
  return "datasets:\n  - " + datasets + "\nmethods: [raw]\nmetrics: [" + metrics + "]\n" + rest;
}

Sweep parse(const std::string& text) { return parse_sweep(text, "c.yaml", catalogue({})); }

Param option(const Sweep& sweep, const std::string& name) {
  return sweep.datasets.at(0).dataset.options.at(name);
}

TEST(ConfigText, StaysAsItWasWrittenWhereTextIsWanted) {
  const Sweep sweep =
      parse(config("{dataset: trajectory, label: 00, estimate: 007, reference: 1e3, name: true, "
                   "period: 1e3, seed: 007}"));
  EXPECT_EQ(sweep.datasets[0].label, "00");
  EXPECT_EQ(option(sweep, "estimate"), Param(std::string("007")));
  EXPECT_EQ(option(sweep, "reference"), Param(std::string("1e3")));
  EXPECT_EQ(option(sweep, "name"), Param(std::string("true")));
  EXPECT_EQ(option(sweep, "period"), Param(1000.0));
  EXPECT_EQ(option(sweep, "seed"), Param(std::int64_t{7}));
}

TEST(ConfigText, IsKeptInSweepsLabelsAndRules) {
  const Sweep sweep =
      parse(config("{dataset: trajectory, label: a, sweep: {estimate: [00, 01]}}\n"
                   "  - {dataset: trajectory, label: 007, estimate: b}",
                   "{metric: ate, label: 1e3}",
                   "table: {where: [label=1e3], value: rmse}\n"
                   "exclude: [{dataset: 007}]\n"));
  ASSERT_EQ(sweep.datasets.size(), 3u);
  EXPECT_EQ(sweep.datasets[1].label, "a (estimate=01)");
  EXPECT_EQ(sweep.metrics[0].label, "1e3");
  EXPECT_EQ(sweep.exclude[0].dataset, "007");
}

TEST(ConfigText, OfLabelsIsOneLineOfAnyCharacters) {
  const std::string label = "a = b: c + d; [m], (x) / y";
  const Sweep sweep = parse(config("{dataset: simulated, label: \"" + label + "\"}",
                                   "{metric: ate, label: \"" + label + "\"}"));
  EXPECT_EQ(sweep.datasets[0].label, label);
  EXPECT_EQ(sweep.metrics[0].label, label);
  for (const char* const escape : {"\\t", "\\n"}) {
    const auto read = [&] {
      parse(config(std::string("{dataset: simulated, label: \"a") + escape + "b\"}"));
    };
    EXPECT_EQ(refusal_of(read),
              "c.yaml:2: label: has a tab or a line break, expected one line of text");
  }
}

TEST(ConfigText, IsKeptInProtocolsButNotInOptionalNumbers) {
  const Sweep sweep = parse(config("{dataset: simulated}",
                                   "{metric: rpe, label: r, tolerance: 1e-1}",
                                   "protocol: {base: kitti, segments: {lengths: 1e2}}\n"));
  EXPECT_EQ(sweep.protocols[0].rules.segments.lengths, "1e2");
  EXPECT_EQ(sweep.metrics[0].metric.options.at("tolerance"), Param(0.1));
}

}  // namespace
}  // namespace loopbench::config_text_test
