#include "harness/sweep/run/evaluation_notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/sweep/model/note_text.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::evaluation_notes_test {

using namespace metrics;
using namespace harness;

namespace {

using namespace test;
using testing::HasSubstr;

/// 100 s on a circle at 10 Hz, estimated at `stamps`.
Sequence estimated_at(const std::vector<double>& stamps) {
  const auto at = [](double stamp) {
    const double angle = 0.05 * stamp;
    return StampedPose{stamp,
                       turned_about_z(angle, 20.0 * Vector3(std::cos(angle), std::sin(angle), 0))};
  };
  Sequence out;
  for (int i = 0; i <= 1000; ++i) out.reference.push_back(at(0.1 * i));
  for (const double stamp : stamps) {
    out.problem.keyframes.push_back(at(stamp));
    out.problem.keyframes.back().world_from_body.translation.z() += 0.1 * std::sin(stamp);
  }
  return out;
}

std::vector<double> every_tenth(int begin, int end) {
  std::vector<double> out;
  for (int i = begin; i < end; ++i) out.push_back(0.1 * i);
  return out;
}

TEST(EvaluationNotes, OfASequenceNameTheTimeThatIsBridged) {
  std::vector<double> stamps = every_tenth(0, 300);
  for (const double stamp : every_tenth(600, 1000)) stamps.push_back(stamp);
  Sweep sweep;
  sweep.protocols = {named_protocol("loopbench")};
  const auto notes = texts(evaluation_notes(estimated_at(stamps), sweep));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "tracking gaps: 30.1 s between keyframes are bridged without a measurement, and not "
            "evaluated (max_estimate_gap)");
}

TEST(EvaluationNotes, OfASequenceNameLittleCoverageAndFewPairs) {
  Sweep sweep;
  sweep.protocols = {named_protocol("loopbench"), named_protocol("tum")};
  const auto notes = texts(evaluation_notes(estimated_at(every_tenth(500, 505)), sweep));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "low coverage: 5 of 5 poses over 0.4 % of the reference's time");
  EXPECT_THAT(notes[1], HasSubstr("few pairs: 5 pairs have 15 coordinates"));
  EXPECT_TRUE(evaluation_notes(estimated_at(every_tenth(0, 1000)), sweep).empty());
}

}  // namespace
}  // namespace loopbench::evaluation_notes_test
