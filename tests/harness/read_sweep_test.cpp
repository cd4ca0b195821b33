#include "harness/sweep/config/read_sweep.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::tiny::read_sweep_test {
namespace {

Sweep parse(const std::string& text) { return parse_sweep(text, "c.yaml", catalogue()); }

/// A valid config in which `line` replaces one of its parts.
std::string config(const std::string& datasets = "- line",
                   const std::string& methods = "- shift",
                   const std::string& metrics = "- ate",
                   const std::string& rest = "") {
  return "datasets:\n  " + datasets + "\nmethods:\n  " + methods + "\nmetrics:\n  " + metrics +
         "\n" + rest;
}

/// A valid config with one more setting, in line 7.
std::string with_setting(const std::string& setting) {
  return config("- line", "- shift", "- ate", setting + "\n");
}

TEST(ReadSweep, FillsInDefaults) {
  const Sweep sweep = parse(config());
  EXPECT_EQ(sweep.name, "c");
  ASSERT_EQ(sweep.datasets.size(), 1u);
  EXPECT_EQ(sweep.methods[0].label, "shift");
  EXPECT_EQ(sweep.repeats, 1);
  EXPECT_EQ(sweep.times, (std::vector<Times>{Times::keyframes, Times::dense}));
  ASSERT_EQ(sweep.protocols.size(), 1u);
  EXPECT_EQ(sweep.protocols[0].label(), "loopbench");
  EXPECT_EQ(sweep.baseline, "");
  EXPECT_EQ(sweep.min_coverage, 0.0);
}

TEST(ReadSweep, TimingIsANumberOfRunsOrAPrecision) {
  const auto timing = [](const std::string& text) {
    const Sweep sweep = parse(with_setting("timing: " + text));
    return std::tuple(sweep.timing, sweep.precision, sweep.serial);
  };
  EXPECT_EQ(timing("3"), std::tuple(3, 0.0, false));
  EXPECT_EQ(timing("true"), std::tuple(100, 0.02, true));
  EXPECT_EQ(timing("{precision: 0.05}"), std::tuple(100, 0.05, false));
  EXPECT_EQ(timing("{precision: 0.05, runs: 20, serial: true}"), std::tuple(20, 0.05, true));
}

TEST(ReadSweep, ComposesStagesAndDistributesOptions) {
  const Sweep sweep = parse(
      config("- line", "- {method: shift + straight, fail: false, straight.by: 2, label: both}"));
  ASSERT_EQ(sweep.methods.size(), 1u);
  EXPECT_EQ(sweep.methods[0].label, "both");
  ASSERT_EQ(sweep.methods[0].stages.size(), 2u);
  EXPECT_EQ(to_text(sweep.methods[0].stages[0].options), "fail=false");
  EXPECT_EQ(to_text(sweep.methods[0].stages[1].options), "by=2");
}

TEST(ReadSweep, LabelsTellWhatIsSwept) {
  const Sweep sweep = parse(config("- {dataset: line, seed: 4, sweep: {bias: [0.1, 0.2]}}",
                                   "- {method: shift, label: s, by: 2, sweep: {fail: [true]}}"));
  EXPECT_EQ(sweep.datasets[0].label, "line (seed=4, bias=0.1)");
  EXPECT_EQ(sweep.datasets[1].label, "line (seed=4, bias=0.2)");
  EXPECT_EQ(sweep.methods[0].label, "s (fail=true)");
}

TEST(ReadSweep, ProtocolsAreNamedChangedAndListed) {
  const auto labels = [](const std::string& text) {
    std::vector<std::string> out;
    for (const NamedProtocol& p : parse(with_setting("protocol: " + text)).protocols)
      out.push_back(p.label());
    return out;
  };
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels("evo"), Labels{"evo"});
  EXPECT_EQ(labels("{base: evo, max_diff: 0.02}"), Labels{"evo (max_diff=0.02)"});
  EXPECT_EQ(labels("{align: origin}"), Labels{"loopbench (align=origin)"});
  EXPECT_EQ(labels("{base: kitti, segments: {lengths: 100}}"),
            Labels{"kitti (segments.lengths=100)"});
  EXPECT_EQ(labels("[evo, {base: evo, align: se3}, rpg-fixed]"),
            (Labels{"evo", "evo (align=se3)", "rpg-fixed"}));
}

TEST(ReadSweep, MemorySizesAreReadAsPeopleWriteThem) {
  const auto bytes = [](const std::string& text) {
    return parse(with_setting("limits: {memory: " + text + "}")).limits.memory;
  };
  EXPECT_EQ(bytes("2GiB"), 2147483648);
  EXPECT_EQ(bytes("1.5 kB"), 1500);
  EXPECT_EQ(bytes("4096"), 4096);
  EXPECT_EQ(bytes("none"), 0);
}

}  // namespace
}  // namespace loopbench::tiny::read_sweep_test
