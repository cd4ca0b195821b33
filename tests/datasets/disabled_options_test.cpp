#include "datasets/core/disabled_options.hpp"

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
    if (entry.name == dataset) return refusal_of<OptionError>([&] { entry.check(given); });
  }
  throw std::logic_error("no such dataset");
}

Params with(Params base, const std::string& name, const Param& value) {
  base.insert_or_assign(name, value);
  return base;
}

const Params kFile{
    {"estimate", "a.txt"}, {"closures.source", "file"}, {"closures.file", "loops.txt"}};
const Params kNone{{"estimate", "a.txt"}, {"reference", "b.txt"}};
const Params kRuns{
    {"estimate", "a.txt"}, {"closures.source", "estimate"}, {"closures.file", "b.txt"}};
const Params kViews{{"estimate", "a.txt"},
                    {"closures.source", "estimate"},
                    {"closures.file", "b.txt"},
                    {"closures.rule", "view"}};
const Params kAlone{{"estimate", "a.txt"}};
const Params kGraph{{"path", "a.g2o"}};
const Params kNoEdges{{"path", "a.g2o"}, {"closures.source", "none"}};

struct Case {
  const char* dataset;
  const Params& given;
  const char* option;
  Param value;
  const char* disabled_by;
};

// An option that is set is rejected even with its default value.
TEST(DisabledOptions, AreRejectedWithTheOptionThatDisablesThem) {
  for (const auto& [dataset, given, option, value, disabled_by] : std::vector<Case>{
           {"trajectory", kFile, "closures.max", std::int64_t{20}, "closures.source = file"},
           {"trajectory", kFile, "closures.radius", 3.0, "closures.source = file"},
           {"trajectory", kFile, "closures.angle", 3.0, "closures.source = file"},
           {"trajectory", kFile, "closures.min_gap", 3.0, "closures.source = file"},
           {"trajectory", kFile, "closures.rule", "view", "closures.source = file"},
           {"trajectory", kRuns, "closures.view.share", 0.5, "closures.rule = distance"},
           {"trajectory", kViews, "closures.radius", 0.5, "closures.rule = view"},
           {"trajectory", kViews, "closures.angle", 30.0, "closures.rule = view"},
           {"trajectory", kFile, "closures.max_interval", 3.0, "closures.source = file"},
           {"trajectory", kNone, "closures.file", "loops.txt", "closures.source = none"},
           {"trajectory", kNone, "closures.radius", 1.0, "closures.source = none"},
           {"trajectory", kNone, "closures.sigma_t", 1.0, "closures.source = none"},
           {"trajectory", kNone, "false_closures.share", 0.5, "closures.source = none"},
           {"trajectory", kAlone, "reference_body.x", 0.1, "without reference, which is empty"},
           {"trajectory", kAlone, "reference_format", "tum", "without reference, which is empty"},
           {"trajectory", kAlone, "keyframes.value", 5.0, "keyframes.rule = all"},
           {"pose_graph", kNoEdges, "closures.max", std::int64_t{3}, "closures.source = none"},
           {"pose_graph", kNoEdges, "closures.true_list", "l.txt", "closures.source = none"},
           {"pose_graph", kNoEdges, "closures.skip_placeholders", true, "closures.source = none"},
           {"pose_graph", kNoEdges, "false_closures.share", 0.5, "closures.source = none"},
           {"pose_graph", kGraph, "reference_body.x", 0.1, "without truth, which is empty"},
           {"pose_graph", kGraph, "truth_axes", "kitti_camera", "without truth, which is empty"},
       }) {
    EXPECT_THAT(
        refusal(dataset, with(given, option, value)),
        AllOf(HasSubstr(std::string(option) + ": has no effect with"), HasSubstr(disabled_by)));
  }
}

TEST(DisabledOptions, OptionsThatHaveAnEffectAreAccepted) {
  EXPECT_THAT(refusal("trajectory", kFile), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kFile, "closures.sigma_t", 0.1)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kFile, "closures.max_diff", 0.1)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kNone, "false_closures.share", 0.0)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kRuns, "closures.radius", 1.0)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kViews, "closures.view.farthest", 9.0)), IsEmpty());
  EXPECT_THAT(refusal("trajectory", with(kViews, "closures.view.nearest", 4.0)),
              HasSubstr("is not below closures.view.farthest"));
  const Params every = with(kAlone, "keyframes.rule", "every");
  EXPECT_THAT(refusal("trajectory", with(every, "keyframes.value", 5.0)), IsEmpty());
}

}  // namespace
}  // namespace loopbench::disabled_options_test
