#include "metrics/protocols/protocols.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "metrics/errors/ate.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/numerics/angle.hpp"
#include "support.hpp"

namespace loopbench::test::protocols_test {

using namespace metrics;

namespace {

std::string refusal(const std::string& name, const Params& changes) {
  return why<OptionError>([&] { named_protocol(name, changes); });
}

std::string word(const char* text) { return text; }

TEST(Protocols, AreNamedOnceVersionedAndCoherent) {
  std::set<std::string> names;
  for (const ProtocolEntry& entry : protocols()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.version.empty()) << entry.name;
    EXPECT_LT(entry.summary.size(), 90u) << entry.name;
    EXPECT_NO_THROW(check(entry.protocol)) << entry.name;
  }
  for (const char* name : {"loopbench",
                           "evo",
                           "tum",
                           "rpg",
                           "rpg-fixed",
                           "kitti",
                           "kitti-double",
                           "ov_eval",
                           "eth3d"}) {
    EXPECT_EQ(names.count(name), 1u) << name;
  }
}

TEST(Protocols, TheDefaultsAreLoopbench) {
  EXPECT_EQ(echo(named_protocol("loopbench").rules), echo(Protocol{}));
  EXPECT_EQ(echo(NamedProtocol{}.rules), echo(Protocol{}));
  EXPECT_EQ(NamedProtocol{}.name, protocols().front().name);
  EXPECT_EQ(NamedProtocol{}.version, protocols().front().version);
}

TEST(Protocols, ChangesAreToldAndNonChangesAreNot) {
  const NamedProtocol got =
      named_protocol("evo", {{"align", word("se3")}, {"max_diff", 0.01}, {"offset", 1.0}});
  EXPECT_EQ(got.label(), "evo (align=se3, offset=1.0)");
  EXPECT_EQ(got.version, "26d0953");
  EXPECT_EQ(got.rules.association, Association::evo);
  EXPECT_EQ(named_protocol("tum").label(), "tum");
}

TEST(Protocols, WhatIsAskedForHasToMatter) {
  EXPECT_EQ(refusal("kitti", {{"max_diff", 0.001}}),
            "max_diff = 0.001: association index does not use it");
  EXPECT_EQ(refusal("loopbench", {{"association", word("interpolate")}, {"max_diff", 0.02}}),
            "max_diff = 0.02: association interpolate does not use it");
  EXPECT_EQ(refusal("evo", {{"max_gap", 0.5}}), "max_gap = 0.5: association evo does not use it");
  EXPECT_NO_THROW(named_protocol("evo", {{"association", word("interpolate")}, {"max_gap", 0.5}}));
}

TEST(Protocols, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  const std::string got = why<InputError>([] { named_protocol("evoo"); });
  EXPECT_EQ(got.find("no protocol is named 'evoo' (known: loopbench, evo, tum, "), 0u) << got;
}

TEST(Protocols, IncoherentOnesAreRefusedWithTheReason) {
  EXPECT_EQ(refusal("evo", {{"align_first", std::int64_t{100}}}),
            "align_first = 100: applies only to least-squares alignments, not to origin or none");
  EXPECT_EQ(refusal("loopbench", {{"align_first", std::int64_t{2}}}),
            "align_first = 2: too few pairs for least squares; for one pose use align: origin");
  EXPECT_EQ(refusal("kitti", {{"offset", 1.0}}), "offset = 1.0: association index ignores stamps");
  EXPECT_EQ(refusal("tum", {{"pairs_from", word("reference")}}),
            "pairs_from = reference: pairs tum always use the estimate");
  EXPECT_EQ(refusal("tum", {{"project", word("xy")}}),
            "project = xy: pairs tum use the unprojected files");
  EXPECT_EQ(refusal("evo", {{"pairs", word("tum_random")}, {"pairs_from", word("reference")}}),
            "pairs_from = reference: pairs tum_random always use the estimate");
  EXPECT_EQ(refusal("evo", {{"max_pairs", std::int64_t{0}}}),
            "max_pairs = 0: applies only to pairs tum and tum_random");
  EXPECT_EQ(refusal("tum", {{"pairs", word("tum_random")}, {"max_pairs", std::int64_t{0}}}),
            "max_pairs = 0: pairs tum_random needs a limit above 0; for all pairs use tum");
  EXPECT_EQ(refusal("rpg", {{"segments.precision", word("float32")}}),
            "segments.precision = float32: requires end beyond, form kitti, angle trace (KITTI "
            "devkit)");
  EXPECT_EQ(refusal("kitti", {{"segments.end", word("nearest")}}),
            "segments.tolerance = 0: expected more than zero");
  EXPECT_EQ(refusal("ov_eval", {{"segments.tolerance", word("8")}}),
            "segments.tolerance = 8: expected less than every length");
  EXPECT_EQ(refusal("rpg", {{"segments.step", std::int64_t{2}}}),
            "segments.step = 2: segments.end = rpg requires step 1");
  EXPECT_EQ(refusal("evo", {{"segments.lengths", word("ten")}}),
            "segments.lengths: 'ten': expected a length in metres or %, as 100 or 20%");
  EXPECT_EQ(refusal("evo", {{"ddof", std::int64_t{2}}}), "ddof = 2: expected 0 <= ddof <= 1");
}

/// Steps of 1 m in 0.1 s along x.
Trajectory road(int size) {
  Trajectory out;
  for (int i = 0; i < size; ++i) out.push_back({0.1 * i, {Rotation::Identity(), Vector3(i, 0, 0)}});
  return out;
}

Evaluation evaluated(const std::string& name,
                     const Trajectory& reference,
                     const Trajectory& estimate) {
  return evaluate(reference, estimate, named_protocol(name).rules);
}

// ov_eval and eth3d are tested rule by rule against their code, without numbers from the originals.

TEST(OvEval, AlignsYawAndPositionAndLeavesTheTilt) {
  const double tilt = 0.1;
  const Pose elsewhere{exp_so3(Vector3(0.0, 0.0, 0.3)) * exp_so3(Vector3(0.0, tilt, 0.0)),
                       Vector3(1.0, 2.0, 3.0)};
  const Evaluation got = evaluated("ov_eval", road(21), moved_by(elsewhere, 1.0, road(21)));
  EXPECT_EQ(got.alignment.scale, 1.0);
  const std::vector<Score> scores = ate(got, {});
  EXPECT_NEAR(find(scores, "rotation", "3d").min, kDegrees * tilt, 1e-9);
  // A chord of the tilt at each of 0..20 from their middle; their variance is (21^2 - 1) / 12.
  EXPECT_NEAR(find(scores, "translation", "3d").rmse,
              2.0 * std::sin(tilt / 2.0) * std::sqrt(440.0 / 12.0),
              1e-9);
}

TEST(OvEval, SegmentsStartEverywhereAndStdDividesByOneLess) {
  Trajectory estimate = road(21);
  estimate[10].world_from_body.rotation = exp_so3(Vector3(0.2, 0.0, 0.0));  // about the path
  const std::vector<Score> got = segments(evaluated("ov_eval", road(21), estimate), {});
  std::set<std::string> axes;
  for (const Score& score : got) axes.insert(score.axis);
  EXPECT_EQ(axes, (std::set<std::string>{"all", "8 m", "16 m"}));  // 24 m and more are too long
  for (const Score& score : got) {
    if (score.axis != "8 m") continue;
    EXPECT_EQ(score.statistics.count, 13u);  // starts 0..12; 2 ends in pose 10, 10 starts there
    if (score.relation == "translation") {
      EXPECT_NEAR(score.statistics.max, 0.0, 1e-12);
    }
    if (score.relation != "rotation" || score.unit != "deg") continue;
    const double mean = 2.0 * 0.2 / 13.0;
    EXPECT_NEAR(score.statistics.mean, kDegrees * mean, 1e-9);
    const double squares = 2.0 * std::pow(0.2 - mean, 2) + 11.0 * mean * mean;
    EXPECT_NEAR(score.statistics.std, kDegrees * std::sqrt(squares / 12.0), 1e-9);
  }
}

TEST(OvEval, AnEndExactlyHalfAMetreOffIsNone) {
  Trajectory off = road(2);
  off[1].world_from_body.translation.x() = 7.5;
  EXPECT_THROW(segments(evaluated("ov_eval", off, off), {}), Undefined);
  off[1].world_from_body.translation.x() = 7.6;
  EXPECT_EQ(find(segments(evaluated("ov_eval", off, off), {}), "translation", "8 m").count, 1u);
}

/// 40 steps along x, then 40 along y, 10 ms each, rotating; `at` is the number of steps done.
Pose on_the_corner(double step, double at) {
  const double x = std::min(at, 40.0);
  return {exp_so3(Vector3(0.0, 0.0, 0.01 * at)), Vector3(step * x, step * (at - x), 0.0)};
}

TEST(Eth3d, InterpolatesTheReferenceOverAtMostASeventyFifth) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i <= 80; ++i) {
    // Without 20 its neighbours are 20 ms apart, and there is no reference between them.
    if (i != 20) reference.push_back({0.01 * i, on_the_corner(0.1, i)});
    if (i < 80) estimate.push_back({0.01 * (i + 0.5), on_the_corner(0.1, i + 0.5)});
  }
  const Evaluation got = evaluated("eth3d", reference, estimate);
  EXPECT_EQ(got.coverage.pairs, 78u);
  EXPECT_NEAR(find(ate(got, {}), "translation", "3d").max, 0.0, 1e-12);
}

TEST(Eth3d, ErrorsAreOfTheMetresGoneAndNothingIsScaled) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i <= 80; ++i) {
    reference.push_back({0.01 * i, on_the_corner(0.101, i)});
    estimate.push_back({0.01 * i, on_the_corner(1.01 * 0.101, i)});
  }
  const Evaluation got = evaluated("eth3d", reference, estimate);
  EXPECT_EQ(got.alignment.scale, 1.0);
  // Five steps are 0.505 m for 0.5 m and 1 % too long: error 1 % of the distance travelled, less
  // across the corner. 20 steps are 2.02 m.
  const std::vector<Score> scores = segments(got, {});
  for (const char* length : {"0.5 m", "1 m", "1.5 m", "2 m"}) {
    EXPECT_NEAR(find(scores, "translation", length).max, 1.0, 1e-9) << length;
    EXPECT_LT(find(scores, "translation", length).min, 0.8) << length;
  }
}

}  // namespace
}  // namespace loopbench::test::protocols_test
