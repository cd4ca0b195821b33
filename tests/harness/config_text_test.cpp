/// Interpretation of scalars depends on the option's type; values of the wrong type are rejected.
#include <gtest/gtest.h>

#include "harness/catalogue/catalogue.hpp"
#include "harness/config/read_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::config_text_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

std::string config(const std::string& datasets,
                   const std::string& metrics = "ate",
                   const std::string& rest = "") {
  return "datasets:\n  - " + datasets + "\nmethods: [raw]\nmetrics: [" + metrics + "]\n" + rest;
}

Sweep parse(const std::string& text) { return parse_sweep(text, "c.yaml", catalogue({})); }

std::string why(const std::string& text) {
  return refusal_of([&] { parse(text); });
}

std::string why_rest(const std::string& rest) {
  return why(config("{dataset: simulated}", "ate", rest));
}

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

TEST(ConfigText, IsKeptInProtocolsButNotInOptionalNumbers) {
  const Sweep sweep = parse(config("{dataset: simulated}",
                                   "{metric: rpe, label: r, tolerance: 1e-1}",
                                   "protocol: {base: kitti, segments: {lengths: 1e2}}\n"));
  EXPECT_EQ(sweep.protocols[0].rules.segments.lengths, "1e2");
  EXPECT_EQ(sweep.metrics[0].metric.options.at("tolerance"), Param(0.1));
}

TEST(ConfigShape, AScalarOrAListWhereAMapBelongsIsRejected) {
  EXPECT_EQ(why_rest("limits: 60\n"),
            "c.yaml:5: limits: found '60', expected a map of seconds, memory, processes, cells");
  EXPECT_EQ(why_rest("limits: {cells: 0}\n"),
            "c.yaml:5: limits.cells: expected a whole number, 1 to 1000000000");
  EXPECT_EQ(why_rest("limits: {memory: none, cells: 2000000}\n"), "");
  EXPECT_EQ(why_rest("exclude: raw\n"),
            "c.yaml:5: exclude: expected a list of {dataset, method} patterns");
  EXPECT_EQ(why_rest("description: [a]\n"), "c.yaml:5: description: expected a string");
  EXPECT_EQ(why(config("{dataset: simulated, keyframes: {}}")),
            "c.yaml:2: keyframes: has no value");
}

TEST(ConfigTable, NamesAreCheckedWhenTheConfigIsRead) {
  EXPECT_EQ(why_rest("table: {rows: [methods]}\n"),
            "c.yaml:5: table.rows: no column is named 'methods'; did you mean 'method'?");
  EXPECT_EQ(why_rest("table:\n  rows: [method]\n  columns: [scor]\n"),
            "c.yaml:7: table.columns: no column is named 'scor'; did you mean 'score'?");
  EXPECT_EQ(why_rest("table: {value: rms}\n"),
            "c.yaml:5: table.value: no statistic is named 'rms'; did you mean 'rmse'?");
  EXPECT_EQ(why_rest("table: {rows: [sequence, repeat], split: [], value: max}\n"), "");
}

TEST(ConfigExclude, APatternThatMatchesNoLabelIsRejected) {
  const auto refusal = [](const std::string& rule) {
    return why(config("{dataset: simulated, label: room}", "ate", "exclude: [" + rule + "]\n"));
  };
  EXPECT_EQ(refusal("{dataset: rom}"),
            "c.yaml:5: exclude: the label of no dataset matches 'rom' (a regular expression for "
            "the complete label)");
  EXPECT_EQ(refusal("{dataset: room, method: dual}"),
            "c.yaml:5: exclude: the label of no method matches 'dual' (a regular expression for "
            "the complete label)");
  EXPECT_EQ(refusal("{dataset: 'ro.*', method: raw}"), "");
}

TEST(ConfigMetric, OptionsThatContradictEachOtherAreRejected) {
  const auto refusal = [](const std::string& metric, const std::string& rest = "") {
    return why(config("{dataset: simulated}", metric, rest));
  };
  EXPECT_EQ(refusal("{metric: rpe, delta: 1.5, unit: frames}"),
            "c.yaml:4: rpe: delta = 1.5: expected a whole number of frames");
  EXPECT_EQ(refusal("{metric: rpe, pairs: tum}"),
            "c.yaml:4: rpe: pairs = tum: needs a protocol with pairs = tum");
  EXPECT_EQ(refusal("{metric: rpe, pairs: tum}", "protocol: tum\n"), "");
  EXPECT_EQ(refusal("{metric: rpe, delta: 1.5, unit: s}"), "");
}

}  // namespace
}  // namespace loopbench::config_text_test
