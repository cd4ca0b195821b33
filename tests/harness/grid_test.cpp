#include "harness/config/grid.hpp"

#include <gtest/gtest.h>

#include "datasets/core/error.hpp"

namespace loopbench::grid_test {

using namespace harness;

namespace {

std::vector<GridPoint> grid(const std::string& text) {
  return expand(parse_yaml(text, "c.yaml"), {"method", "label"});
}

std::string text_of(const GridPoint& point) {
  std::string out;
  for (const Setting& s : point.settings) out += s.name + "=" + to_text(s.value) + " ";
  return out;
}

std::string why(const std::string& text) {
  try {
    grid(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Grid, FlattensNestedMapsAndSkipsReservedKeys) {
  const auto points = grid("method: dm\nsegment: {speed: {band: 0.33}, min: 3}\n");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(text_of(points[0]), "segment.speed.band=0.33 segment.min=3 ");
  EXPECT_TRUE(points[0].swept.empty());
}

TEST(Grid, TakesEveryCombinationFirstKeySlowest) {
  const auto points = grid("method: m\nsweep:\n  a: [1, 2]\n  b: [x, y]\n");
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(text_of(points[0]), "a=1 b=x ");
  EXPECT_EQ(text_of(points[1]), "a=1 b=y ");
  EXPECT_EQ(text_of(points[2]), "a=2 b=x ");
  EXPECT_EQ(points[3].swept, (std::vector<std::string>{"a", "b"}));
}

TEST(Grid, WalksZippedListsTogether) {
  const auto points = grid("method: m\nzip: {a: [1, 2], b: [x, y]}\nsweep: {c: [true, false]}\n");
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(text_of(points[0]), "c=true a=1 b=x ");
  EXPECT_EQ(text_of(points[1]), "c=true a=2 b=y ");
}

TEST(Grid, RangesReachTheirEndsExactly) {
  const auto linear = grid("method: m\nsweep: {a: {from: 0.1, to: 0.7, steps: 3}}\n");
  ASSERT_EQ(linear.size(), 3u);
  EXPECT_EQ(linear[0].settings[0].value, Param(0.1));
  EXPECT_DOUBLE_EQ(std::get<double>(linear[1].settings[0].value), 0.4);
  EXPECT_EQ(linear[2].settings[0].value, Param(0.7));

  const auto log = grid("method: m\nsweep: {a: {from: 1, to: 100, steps: 3, log: true}}\n");
  EXPECT_DOUBLE_EQ(std::get<double>(log[1].settings[0].value), 10.0);

  const auto integers = grid("method: m\nsweep: {a: {from: 10, to: 30, steps: 3}}\n");
  EXPECT_EQ(integers[1].settings[0].value, Param(std::int64_t{20}));
}

TEST(Grid, RangesHoldTheNumbersThatPeopleWouldWrite) {
  const auto texts = [](const std::string& range) {
    std::string out;
    for (const GridPoint& point : grid("method: m\nsweep: {a: " + range + "}\n")) {
      out += text_of(point);
    }
    return out;
  };
  EXPECT_EQ(texts("{from: 0.1, to: 0.5, steps: 5}"), "a=0.1 a=0.2 a=0.3 a=0.4 a=0.5 ");
  EXPECT_EQ(texts("{from: 0, to: 0.7, steps: 8}"),
            "a=0.0 a=0.1 a=0.2 a=0.3 a=0.4 a=0.5 a=0.6 a=0.7 ");
  EXPECT_EQ(texts("{from: 0.001, to: 1, steps: 4, log: true}"), "a=0.001 a=0.01 a=0.1 a=1.0 ");
  // Written values keep all digits.
  EXPECT_EQ(texts("{from: 0.30000000000000004, to: 1, steps: 2}"), "a=0.30000000000000004 a=1.0 ");
}

TEST(Grid, RefusesWithFileAndLine) {
  EXPECT_EQ(why("method: m\na: [1, 2]\n"),
            "c.yaml:2: a: lists are accepted only under 'sweep' or 'zip'");
  EXPECT_EQ(why("method: m\na:\n"), "c.yaml:2: a: has no value");
  EXPECT_EQ(why("method: m\nsweep: {a: 3}\n"), "c.yaml:2: a: expected a list or {from, to, steps}");
  EXPECT_EQ(why("method: m\nsweep: {a: []}\n"),
            "c.yaml:2: a: expected a list or {from, to, steps}");
  EXPECT_EQ(why("method: m\nzip:\n  a: [1, 2]\n  b: [1]\n"),
            "c.yaml:4: b: has 1 values, the others under 'zip' have 2");
  EXPECT_EQ(why("method: m\na: 1\nsweep: {a: [1, 2]}\n"),
            "c.yaml:3: a: is set twice in this entry");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: 0, to: 1, steps: 3, log: true}}\n"),
            "c.yaml:2: a range with log: true needs from > 0 and to > 0");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: 0, to: 1}}\n"),
            "c.yaml:2: a range needs from, to and steps; 'steps' is missing");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: 0, to: 1, steps: 0}}\n"),
            "c.yaml:2: steps: expected a whole number, 1 to 100000");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: -1e308, to: 1e308, steps: 3}}\n"),
            "c.yaml:2: the range from .. to is too wide for double precision");
  EXPECT_EQ(why("method: m\nsweep:\n  a: {from: 1, to: 101, steps: 101}\n"
                "  b: {from: 1, to: 100, steps: 100}\n"),
            "c.yaml:1: sweeps over more than 10000 combinations");
}

TEST(Grid, RefusesMoreThanItCouldHoldBeforeHoldingIt) {
  const std::string many = "c.yaml:1: sweeps over more than 10000 combinations";
  std::string sweep = "method: m\nsweep:\n";
  std::string zip = "method: m\nzip:\n";
  std::string plain = "method: m\n";
  for (int i = 0; i < 201; ++i) {
    const std::string name = "a" + std::to_string(i);
    sweep += "  " + name + ": [1]\n";
    zip += "  " + name + ": [1]\n";
    plain += name + ": 1\n";
  }
  EXPECT_EQ(why(sweep), "c.yaml:1: sets 201 options, expected at most 200");
  EXPECT_EQ(why(zip), "c.yaml:1: sets 201 options, expected at most 200");
  EXPECT_EQ(why(plain), "c.yaml:1: sets 201 options, expected at most 200");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: 0, to: 1, steps: 100000}}\n"), many);
  EXPECT_EQ(why("method: m\nzip: {a: {from: 0, to: 1, steps: 100000}}\n"),
            "c.yaml:2: sweeps over more than 10000 combinations");
  EXPECT_EQ(why("method: m\nsweep: {a: {from: 0, to: 1, steps: 100}}\n"
                "zip: {b: {from: 0, to: 1, steps: 101}}\n"),
            many);
}

}  // namespace
}  // namespace loopbench::grid_test
