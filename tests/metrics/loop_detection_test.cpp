// Precision and recall of place recognition, computed by hand.
#include "metrics/correction/loop_detection.hpp"

#include "datasets/core/sequence.hpp"

namespace loopbench::loop_detection_test {

using namespace metrics;

namespace {

/// Forward along x and back, one keyframe per second: 0 1 2 3 2 1 0 m, so 4, 5, 6 revisit 2, 1, 0.
Sequence out_and_back() {
  Sequence out;
  for (const double x : {0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0}) {
    const auto stamp = static_cast<double>(out.reference.size());
    out.reference.push_back({stamp, {Rotation::Identity(), Vector3(x, 0.0, 0.0)}});
  }
  out.problem.keyframes = out.reference;
  return out;
}

Detection evaluated(const Sequence& sequence) {
  DetectionRule rule;
  rule.radius = 0.5;
  rule.min_gap = 1.5;
  return evaluate_detection(sequence.problem, sequence.reference, sequence.loop_candidates, rule);
}

TEST(LoopDetection, AllRightIsOneThroughout) {
  Sequence s = out_and_back();
  s.loop_candidates = {{2, 4, 9.0, true}, {1, 5, 8.0, true}, {0, 6, 7.0, true}};
  s.problem.closures = {{2, 4, {}}, {1, 5, {}}};
  const auto score = evaluated(s);
  EXPECT_EQ(score.revisits, 3u);
  EXPECT_EQ(score.average_precision, 1.0);
  EXPECT_EQ(score.full_precision_recall, 1.0);
  EXPECT_EQ(score.precision, 1.0);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision_at[9], 1.0);
  EXPECT_EQ(score.wrong_pose, 0u);
}

TEST(LoopDetection, AWrongOneInTheMiddleCostsWhatTheDefinitionSays) {
  Sequence s = out_and_back();
  // Right, wrong, right: precision 1, 1/2, 2/3 at recall 1/3, 1/3, 2/3.
  s.loop_candidates = {{2, 4, 9.0, true}, {3, 5, 8.0, true}, {0, 6, 7.0, false}};
  s.problem.closures = {{2, 4, {}}, {3, 5, {Rotation::Identity(), Vector3(-1.0, 0.0, 0.0)}}};
  const auto score = evaluated(s);
  EXPECT_NEAR(score.average_precision, 1.0 / 3.0 + 2.0 / 3.0 / 3.0, 1e-12);
  EXPECT_NEAR(score.full_precision_recall, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(score.precision, 0.5);
  EXPECT_NEAR(score.recall, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(score.precision_at[2], 1.0);
  EXPECT_NEAR(score.precision_at[3], 2.0 / 3.0, 1e-12);
  EXPECT_EQ(score.precision_at[6], 0.0);  // not reached
  EXPECT_EQ(score.wrong_pose, 1u);        // the true distance is 2 m, not 1
}

TEST(LoopDetection, EqualScoresCountTogether) {
  Sequence s = out_and_back();
  s.loop_candidates = {{2, 4, 9.0, true}, {3, 5, 9.0, true}};
  EXPECT_NEAR(evaluated(s).average_precision, 0.5 / 3.0, 1e-12);
  EXPECT_EQ(evaluated(s).full_precision_recall, 0.0);
}

TEST(LoopDetection, GivesRowsAndDeclinesWhereThereIsNothingToEvaluate) {
  Sequence s = out_and_back();
  s.loop_candidates = {{2, 4, 9.0, true}, {3, 5, 8.0, true}, {0, 6, 7.0, false}};
  Evaluation evaluation;
  evaluation.context.problem = &s.problem;
  evaluation.context.reference = &s.reference;
  DetectionRule rule;
  rule.radius = 0.5;
  rule.min_gap = 1.5;
  EXPECT_THROW(loop_detection(evaluation, rule), Undefined);  // two files
  evaluation.context.loop_candidates = &s.loop_candidates;
  const std::vector<Score> rows = loop_detection(evaluation, rule);
  const auto value = [&](const std::string& relation, const std::string& axis = "") {
    for (const Score& row : rows) {
      if (row.relation == relation && row.axis == axis) return row.statistics.mean;
    }
    return -1.0;
  };
  EXPECT_EQ(value("revisits"), 3.0);
  EXPECT_EQ(value("closures"), 2.0);
  EXPECT_EQ(value("precision"), 0.5);
  EXPECT_NEAR(value("average_precision"), 1.0 / 3.0 + 2.0 / 3.0 / 3.0, 1e-12);
  EXPECT_EQ(value("precision_at_recall", "0.3"), 1.0);
  EXPECT_NEAR(value("precision_at_recall", "0.4"), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(value("precision_at_recall", "1.0"), 0.0);
  s.loop_candidates.clear();
  EXPECT_THROW(loop_detection(evaluation, rule), Undefined);
  s.loop_candidates = {{2, 4, 9.0, true}};
  s.reference.clear();
  EXPECT_THROW(loop_detection(evaluation, rule), Undefined);
}

TEST(LoopDetection, NeedsAReferenceAndFindsNoRevisitWhereThereIsNone) {
  Sequence s = out_and_back();
  s.reference.resize(4);
  s.problem.keyframes.resize(4);
  EXPECT_EQ(evaluated(s).revisits, 0u);
  EXPECT_EQ(evaluated(s).precision, 1.0);
  s.reference.clear();
  EXPECT_THROW(evaluated(s), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::loop_detection_test
