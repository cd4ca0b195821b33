#include "harness/sweep/config/grid.hpp"

#include <gtest/gtest.h>

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

TEST(Grid, RangesHoldTheNumbersThatPeopleWouldWrite) {
  const auto texts = [](const std::string& range) {
    std::string out;
    for (const GridPoint& point : grid("method: m\nsweep: {a: " + range + "}\n")) {
      out += text_of(point);
    }
    return out;
  };
  EXPECT_EQ(texts("{from: 10, to: 30, steps: 3}"), "a=10 a=20 a=30 ");
  EXPECT_EQ(texts("{from: 0.1, to: 0.5, steps: 5}"), "a=0.1 a=0.2 a=0.3 a=0.4 a=0.5 ");
  EXPECT_EQ(texts("{from: 0, to: 0.7, steps: 8}"),
            "a=0.0 a=0.1 a=0.2 a=0.3 a=0.4 a=0.5 a=0.6 a=0.7 ");
  EXPECT_EQ(texts("{from: 0.001, to: 1, steps: 4, log: true}"), "a=0.001 a=0.01 a=0.1 a=1.0 ");
  // Written values keep all digits.
  EXPECT_EQ(texts("{from: 0.30000000000000004, to: 1, steps: 2}"), "a=0.30000000000000004 a=1.0 ");
}

}  // namespace
}  // namespace loopbench::grid_test
