#include "harness/config/read_sweep.hpp"

#include <gtest/gtest.h>

#include "harness/catalogue/catalogue.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::read_sweep_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

Sweep parse(const std::string& text) { return parse_sweep(text, "c.yaml", tiny::catalogue()); }

std::string why(const std::string& text) {
  return refusal_of([&] { parse(text); });
}

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

TEST(ReadSweep, RefusesWithPlaceAndSuggestion) {
  EXPECT_EQ(why(config("- lien")), "c.yaml:2: no dataset is named 'lien'; did you mean 'line'?");
  EXPECT_EQ(why(config("- line", "- shfit + straight")),
            "c.yaml:4: no method is named 'shfit'; did you mean 'shift'?");
  EXPECT_EQ(why(config("- dataset: line\n    bias: 2")),
            "c.yaml:3: line: bias = 2.0: expected 0 <= bias <= 1");
  EXPECT_EQ(why(config("- dataset: line\n    bais: 0.5")),
            "c.yaml:3: line: bais: unknown option; did you mean 'bias'? (has: bias, seed)");
  EXPECT_EQ(why(config("- line", "- {method: shift + straight, by: 1}")),
            "c.yaml:4: by: both stages have this option; use shift.by or straight.by");
  EXPECT_EQ(why(config("- line", "- {method: shift + straight, fial: true}")),
            "c.yaml:4: no option of either stage is named 'fial'; did you mean 'fail'?");
  EXPECT_EQ(why(config("- line", "- straight + shift")),
            "c.yaml:4: straight + shift: is smoother + corrector; stages compose as corrector + "
            "smoother, after a replay if there is one");
  EXPECT_EQ(why(config("- line", "- shift\n  - shift")),
            "c.yaml:5: two entries of methods have the label 'shift'; set label in one");
  EXPECT_EQ(why(config("- line", "- shift", "- {metric: ate, power: 7}")),
            "c.yaml:6: ate: power = 7: expected 1 <= power <= 2");
}

TEST(ReadSweep, RefusesUnknownAndBrokenSettings) {
  EXPECT_EQ(why(with_setting("repaets: 3")),
            "c.yaml:7: no setting is named 'repaets'; did you mean 'repeats'?");
  EXPECT_EQ(why(with_setting("repeats: 0")),
            "c.yaml:7: repeats: expected a whole number, 1 to 1000000");
  EXPECT_EQ(why(with_setting("times: [keyframes, sometimes]")),
            "c.yaml:7: times: expected keyframes | dense");
  EXPECT_EQ(
      why(with_setting("protocol:\n  align: se4")),
      "c.yaml:8: protocol: align = se4: expected one of se3 | sim3 | scale | posyaw | origin | "
      "posyaw_origin | none; did you mean 'se3'?");
  EXPECT_EQ(why(with_setting("baseline: shifd")),
            "c.yaml:7: baseline: no method is named 'shifd'; did you mean 'shift'?");
  EXPECT_EQ(why(with_setting("exclude: [{method: '('}]")),
            "c.yaml:7: method: '(' is not a regular expression (missing ): ()");
  EXPECT_EQ(why(with_setting("min_coverage: 80")),
            "c.yaml:7: min_coverage = 80.0: expected 0 <= min_coverage <= 1");
  EXPECT_EQ(why("methods: [shift]\nmetrics: [ate]\n"), "c.yaml:1: 'datasets' is missing");
  EXPECT_EQ(why("- 1\n"), "c.yaml:1: expected a map with datasets, methods and metrics");
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

TEST(ReadSweep, RefusesProtocolsThatCannotBe) {
  const auto refusal = [](const std::string& text) {
    return why(with_setting("protocol: " + text));
  };
  EXPECT_EQ(refusal("evoo"),
            "c.yaml:7: protocol: no protocol is named 'evoo'; did you mean 'evo'?");
  EXPECT_EQ(refusal("[evo, {base: evo}]"), "c.yaml:7: protocol: 'evo' is listed twice");
  EXPECT_EQ(refusal("{sweep: {align: [se3, sim3]}}"),
            "c.yaml:7: protocol: cannot be swept; use a list of protocols");
  EXPECT_EQ(refusal("\n  base: kitti\n  offset: 1"),
            "c.yaml:9: protocol: offset = 1.0: association index ignores stamps");
}

TEST(ReadSweep, MemorySizesAreReadAsPeopleWriteThem) {
  const auto bytes = [](const std::string& text) {
    return parse(with_setting("limits: {memory: " + text + "}")).limits.memory;
  };
  EXPECT_EQ(bytes("2GiB"), 2147483648);
  EXPECT_EQ(bytes("1.5 kB"), 1500);
  EXPECT_EQ(bytes("4096"), 4096);
  EXPECT_EQ(bytes("none"), 0);
  for (const char* wrong : {"''", "GiB", "-1MB", "2 gigabytes", "nan", "0", "1e30GB"}) {
    EXPECT_THROW(bytes(wrong), InputError) << wrong;
  }
}

// Contradictions between options are found before the sweep starts, with their line.
TEST(ReadSweep, ChecksOptionsOfADatasetTogether) {
  const auto refusal = [](const std::string& dataset) {
    const std::string text = "datasets:\n  - {" + dataset + "}\nmethods: [raw]\nmetrics: [ate]\n";
    return refusal_of([&] { parse_sweep(text, "c.yaml", catalogue({})); });
  };
  EXPECT_EQ(refusal("dataset: trajectory, reference: gt.txt"),
            "c.yaml:2: trajectory: estimate: is empty, expected a trajectory file");
  EXPECT_EQ(refusal("dataset: trajectory, estimate: e.txt, reference_body: {qw: 0.5}"),
            "c.yaml:2: trajectory: reference_body: qx, qy, qz, qw have norm 0.5, expected a unit "
            "quaternion");
  EXPECT_EQ(refusal("dataset: trajectory, estimate: e.txt, reference: r.txt, "
                    "reference_body: {x: 1}"),
            "");
}

}  // namespace
}  // namespace loopbench::read_sweep_test
