#include "datasets/disabled_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/dataset.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::disabled_options_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::string refusal(const std::string& dataset, const Params& given) {
  for (const DatasetEntry& entry : datasets()) {
    if (entry.name != dataset) continue;
    try {
      entry.check(given);
    } catch (const OptionError& error) {
      return error.what();
    }
    return "";
  }
  throw std::logic_error("no such dataset");
}

Params with(Params base, const std::string& name, const Param& value) {
  base.insert_or_assign(name, value);
  return base;
}

TEST(DisabledOptions, OfMeasuredClosuresAreRejectedForClosuresFromAFile) {
  const Params file{
      {"estimate", "a.txt"}, {"closures.source", "file"}, {"closures.file", "loops.txt"}};
  EXPECT_THAT(refusal("trajectory", file), IsEmpty());
  // Also rejected with the default value, because the config sets it.
  EXPECT_EQ(refusal("trajectory", with(file, "closures.max", std::int64_t{20})),
            "closures.max: has no effect with closures.source = file, expected closures.source = "
            "reference or estimate");
  for (const char* option :
       {"closures.radius", "closures.angle", "closures.min_gap", "closures.max_interval"}) {
    EXPECT_THAT(refusal("trajectory", with(file, option, 3.0)),
                AllOf(HasSubstr(option), HasSubstr("closures.source = file")));
  }
  EXPECT_THAT(refusal("trajectory", with(file, "closures.sigma_t", 0.1)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(file, "closures.max_diff", 0.1)), IsEmpty());
}

TEST(DisabledOptions, OfClosuresAreRejectedWithoutClosures) {
  const Params none{{"estimate", "a.txt"}, {"reference", "b.txt"}};
  for (const auto& [option, value] : Params{{"closures.file", "loops.txt"},
                                            {"closures.radius", 1.0},
                                            {"closures.sigma_t", 1.0},
                                            {"false_closures.share", 0.5}}) {
    EXPECT_THAT(refusal("trajectory", with(none, option, value)),
                AllOf(HasSubstr(option), HasSubstr("closures.source = none")));
  }
  EXPECT_THAT(refusal("trajectory", with(none, "false_closures.share", 0.0)), IsEmpty());
  const Params graph{{"path", "a.g2o"}, {"closures.source", "none"}};
  for (const auto& [option, value] : Params{{"closures.max", std::int64_t{3}},
                                            {"closures.true_list", "list.txt"},
                                            {"closures.skip_placeholders", true},
                                            {"false_closures.share", 0.5}}) {
    EXPECT_THAT(refusal("pose_graph", with(graph, option, value)),
                AllOf(HasSubstr(option), HasSubstr("closures.source = none")));
  }
}

TEST(DisabledOptions, OfTheReferenceAreRejectedWithoutOne) {
  const Params alone{{"estimate", "a.txt"}};
  EXPECT_EQ(refusal("trajectory", with(alone, "reference_body.x", 0.1)),
            "reference_body.x: has no effect without reference, which is empty");
  EXPECT_THAT(refusal("trajectory", with(alone, "reference_format", "tum")),
              HasSubstr("without reference"));
  const Params graph{{"path", "a.g2o"}};
  EXPECT_THAT(refusal("pose_graph", with(graph, "reference_body.x", 0.1)),
              HasSubstr("without truth"));
  EXPECT_THAT(refusal("pose_graph", with(graph, "truth_axes", "kitti_camera")),
              HasSubstr("without truth"));
}

TEST(DisabledOptions, KeyframeValueIsRejectedWithRuleAll) {
  const Params alone{{"estimate", "a.txt"}, {"keyframes.value", 5.0}};
  EXPECT_THAT(refusal("trajectory", alone),
              AllOf(HasSubstr("keyframes.value"), HasSubstr("keyframes.rule = all")));
  EXPECT_THAT(refusal("trajectory", with(alone, "keyframes.rule", "every")), IsEmpty());
}

TEST(DisabledOptions, PitchDriftIsRejectedInThePlane) {
  EXPECT_EQ(refusal("simulated", {{"planar", true}, {"drift.pitch_per_metre", 0.01}}),
            "drift.pitch_per_metre = 0.01: causes motion out of the plane, expected 0 with planar "
            "= true");
  EXPECT_THAT(refusal("simulated", {{"planar", true}, {"drift.yaw_per_metre", 0.01}}), IsEmpty());
  EXPECT_THAT(
      refusal("simulated", {{"closures.max", std::int64_t{0}}, {"closures.false_share", 0.5}}),
      AllOf(HasSubstr("closures.false_share"), HasSubstr("closures.max = 0")));
}

}  // namespace
}  // namespace loopbench::disabled_options_test
