#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "methods/correctors/consensus/judgement.hpp"
#include "tests/metrics/doctor_pairs.hpp"
#include "tests/support/rounds.hpp"

namespace loopbench::test::doctor_closures_test {
namespace {

/// Two rounds on a circle with closures between them, and drift in the odometry.
/// `noise_scale`: of errors and stated deviations.
Problem rounds(double noise_scale = 1.0) {
  Problem out;
  const std::size_t round = 60;
  const auto pose = [&](std::size_t i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(round);
    const Pose on_circle{exp_so3({0, 0, angle}),
                         {20 * std::sin(angle), 20 - 20 * std::cos(angle), 0}};
    // On another lane in the second round.
    return on_circle * Pose{Rotation::Identity(), {0, i < round ? 0.0 : 1.5, 0}};
  };
  const auto noise = [&](std::size_t i) {
    const auto k = static_cast<double>(i);
    return exp_se3(noise_scale *
                   twist(0.02 * Vector3(std::sin(k * k), std::cos(3 * k * k), std::sin(k + 1)),
                         0.004 * Vector3(std::sin(5 * k * k), std::cos(k * k), std::sin(2 * k))));
  };
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << 2500, 2500, 2500, 62500, 62500, 62500;
  information /= noise_scale * noise_scale;
  for (std::size_t i = 0; i < 2 * round; ++i) {
    out.keyframes.push_back({static_cast<double>(i), pose(i)});
    if (i == 0) continue;
    out.odometry.push_back({i - 1, i, pose(i - 1).inverse() * pose(i) * noise(i), information});
  }
  for (std::size_t i = 0; i + 4 < round; i += 2) {
    // Measured from one keyframe before the revisited place, so that the inverse differs.
    out.closures.push_back({i,
                            i + round + 1,
                            pose(i).inverse() * pose(i + round + 1) * noise(7 * i + 3),
                            information});
  }
  return out;
}

Pose true_pose(const Problem& problem, std::size_t from, std::size_t to) {
  return problem.keyframes[from].world_from_body.inverse() * problem.keyframes[to].world_from_body;
}

/// A closure that is wrong by `up` [m].
void add_false_closure(Problem& problem, std::size_t from, std::size_t to, double up) {
  Pose pose = true_pose(problem, from, to);
  pose.translation.z() += up;
  problem.closures.push_back({from, to, pose, problem.closures[0].information});
}

void invert(std::vector<Edge>& edges) {
  for (Edge& edge : edges) edge.from_from_to = edge.from_from_to.inverse();
}

void scale_information(std::vector<Edge>& edges, double factor) {
  for (Edge& edge : edges) edge.information *= factor;
}

struct Change {
  const char* name;
  std::function<void(Problem&)> change;
  std::vector<Fault::Name> faults;
};

TEST(DoctorOfClosures, EdgesInTheOtherDirectionOrInTheAxesOfTheWorld) {
  Problem inverted = rounds();
  invert(inverted.odometry);
  invert(inverted.closures);
  const InputFinding found = only(check_closures(inverted), Fault::closure_direction);
  EXPECT_THAT(found.evidence, HasSubstr("the edges of the odometry fit the vertices"));
  for (const bool of_odometry : {true, false}) {
    Problem in_world = rounds();
    for (Edge& edge : of_odometry ? in_world.odometry : in_world.closures) {
      Pose& pose = edge.from_from_to;
      pose.translation = in_world.keyframes[edge.from].world_from_body.rotation * pose.translation;
    }
    EXPECT_THAT(only(check_closures(in_world), Fault::closure_convention).evidence,
                HasSubstr(of_odometry ? "odometry have their translations in the axes"
                                      : "closures have their translations in the axes"));
  }
}

TEST(DoctorOfClosures, OneFindingForOneChange) {
  const Change changes[] = {
      {"none", [](Problem&) {}, {}},
      {"inverted closures", [](Problem& p) { invert(p.closures); }, {Fault::closure_direction}},
      {"a false closure",
       [](Problem& p) {
         p.closures.push_back({10, 40, Pose{}, p.closures[0].information});
       },
       {Fault::closure_gap}},
      // Of closures that are mostly false, no covariance can be judged.
      {"many false closures",
       [](Problem& p) {
         const Matrix6 information = p.closures[0].information;
         for (std::size_t i = 0; i < 50; ++i) p.closures.push_back({i, i + 25, {}, information});
       },
       {Fault::placeholders}},
      {"information of another scale",
       [](Problem& p) {
         scale_information(p.odometry, 1e4);
         scale_information(p.closures, 1e4);
       },
       {Fault::information}},
      {"information of closures of another scale",
       [](Problem& p) { scale_information(p.closures, 1e-6); },
       {Fault::information}},
      // A closure that is listed twice agrees with itself.
      {"a repeated closure", [](Problem& p) { p.closures.push_back(p.closures.back()); }, {}},
  };
  for (const auto& [name, change, expected] : changes) {
    Problem problem = rounds();
    change(problem);
    EXPECT_EQ(closure_faults(problem), expected) << name;
  }
}

TEST(DoctorOfClosures, ConventionsOfTurnedClosures) {
  const auto changed = [](auto change) {
    Problem problem = rounds();
    for (Edge& edge : problem.closures) {
      // Revisits in another direction, so that the rotations matter.
      edge.from_from_to = edge.from_from_to * Pose{exp_so3({0, 0, 0.4}), Vector3::Zero()};
      edge.from_from_to = change(edge.from_from_to);
    }
    for (std::size_t i = 60; i < 120; ++i) {  // the second round is driven with another heading
      problem.keyframes[i].world_from_body.rotation =
          problem.keyframes[i].world_from_body.rotation * exp_so3({0, 0, 0.4});
      Edge& edge = problem.odometry[i - 1];
      const Rotation heading = exp_so3({0, 0, 0.4});
      if (i > 60)
        edge.from_from_to = Pose{heading.conjugate(), Vector3::Zero()} * edge.from_from_to;
      edge.from_from_to = edge.from_from_to * Pose{heading, Vector3::Zero()};
    }
    return closure_faults(problem);
  };
  EXPECT_THAT(changed([](const Pose& p) { return p; }), IsEmpty());
  EXPECT_THAT(changed(misordered), ElementsAre(Fault::closure_convention));
  EXPECT_THAT(changed([](const Pose& p) {
                const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), Vector3::Zero()};
                return camera.inverse() * p * camera;
              }),
              ElementsAre(Fault::closure_convention));
}

/// Without neighbours, and with too little drift to hide the motion between the lanes.
TEST(DoctorOfClosures, RepeatedOrExactClosuresShowNothingAboutTheirInformation) {
  Problem repeated = rounds();
  repeated.closures.clear();
  for (const Edge& closure : rounds().closures) {
    repeated.closures.insert(repeated.closures.end(), 2, closure);
  }
  EXPECT_THAT(closure_faults(repeated), IsEmpty());
  Problem exact = rounds();
  for (auto* edges : {&exact.odometry, &exact.closures}) {
    for (Edge& edge : *edges) edge.from_from_to = true_pose(exact, edge.from, edge.to);
  }
  EXPECT_THAT(closure_faults(exact), IsEmpty());
}

/// As many as `loops` lists.
TEST(DoctorOfClosures, CountEachClosureOfTheFile) {
  Problem problem = rounds();
  for (int copies = 0; copies < 2; ++copies) add_false_closure(problem, 10, 110, 60);
  const std::vector<InputFinding> found = check_closures(problem);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].value, 2.0);
  EXPECT_THAT(found[0].evidence, HasSubstr(fmt::format("2 of {}", problem.closures.size())));
}

/// Over another closure, any tilt makes the yaw as uncertain as roll and pitch.
TEST(DoctorOfClosures, ThatMeasureYawAloneShowNothingAboutTheirInformation) {
  Problem problem = rounds();
  for (Edge& edge : problem.closures) {
    edge.from_from_to.translation.setZero();
    edge.information.setZero();
    edge.information.diagonal() << 1e-6, 1e-6, 1e-6, 4e-6, 4e-6, 62500;
  }
  EXPECT_THAT(closure_faults(problem), IsEmpty());
}

TEST(DoctorOfClosures, FewClosuresAreComparedWithTheOdometry) {
  Problem problem = rounds();
  problem.closures = {problem.closures[0], problem.closures[13], problem.closures[26]};
  EXPECT_THAT(closure_faults(problem), IsEmpty());
  Problem inverted = problem;
  invert(inverted.closures);
  EXPECT_THAT(closure_faults(inverted), ElementsAre(Fault::closure_direction));
  scale_information(problem.odometry, 1e4);
  scale_information(problem.closures, 1e4);
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::information));
}

TEST(DoctorOfClosures, AFalseClosureWithinTheUsualDriftContradictsItsCovariance) {
  Problem problem = rounds();
  // The gap is 30 % of the loop's length, most loops drift by 5 %.
  for (Edge& edge : problem.odometry) edge.from_from_to.translation *= 1.06;
  add_false_closure(problem, 10, 110, 60);
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::closure_gap));
}

TEST(DoctorOfClosures, AFalseClosureThatOnlyOtherClosuresContradict) {
  Problem problem = rounds();
  // The drift of the heading allows for more than 15 m over two rounds.
  for (Edge& edge : problem.odometry) {
    edge.from_from_to = edge.from_from_to * Pose{exp_so3({0, 0, 0.003}), Vector3::Zero()};
  }
  add_false_closure(problem, 10, 110, 15);
  const InputFinding found = only(check_closures(problem), Fault::closure_gap);
  EXPECT_EQ(found.value, 1.0);
  EXPECT_THAT(found.evidence, HasSubstr("contradict the odometry or other closures"));
  EXPECT_THAT(found.evidence, HasSubstr("10.0 s -> 110.0 s ("));
}

/// Drift makes the gaps of long loops larger than that of the false closure, so that the odometry
/// proves nothing: the rms would grow without it. Shortest paths do.
TEST(DoctorOfClosures, AFalseClosureWithASmallerGapThanMost) {
  Problem problem = rounds();
  for (Edge& edge : problem.odometry) {
    edge.from_from_to = edge.from_from_to * Pose{exp_so3({0, 0, 0.01}), Vector3::Zero()};
  }
  add_false_closure(problem, 10, 14, 6);
  const auto found = check_closures(problem);
  ASSERT_FALSE(found.empty());  // the drift is larger than stated, too
  EXPECT_EQ(found[0].fault, Fault::closure_gap);
  EXPECT_THAT(found[0].evidence, HasSubstr("contradict the odometry or other closures"));
  EXPECT_THAT(found[0].evidence, HasSubstr("10.0 s -> 14.0 s"));
}

TEST(DoctorOfClosures, GapsAreDistances) {
  Problem problem = rounds();
  add_false_closure(problem, 10, 110, 60);
  const std::string evidence = only(check_closures(problem), Fault::closure_gap).evidence;
  const std::size_t at = evidence.find("10.0 s -> 110.0 s (");
  ASSERT_NE(at, std::string::npos) << evidence;
  EXPECT_NEAR(std::atof(evidence.c_str() + at + 19), 60.0, 2.0);
}

/// A body that comes back to the same pose states the identity; the drift of its odometry is as
/// large as stated.
TEST(DoctorOfClosures, IdentitiesThatAgreeWereMeasured) {
  Problem problem = test::rounds(1, 0.05);
  for (Edge& edge : problem.closures) edge.from_from_to = Pose{};
  EXPECT_THAT(closure_faults(problem), IsEmpty());
}

TEST(DoctorOfClosures, ClosuresThatJoinSeveralChains) {
  Problem problem = rounds();
  std::erase_if(problem.odometry, [](const Edge& edge) { return edge.from == 59; });
  EXPECT_THAT(closure_faults(problem), IsEmpty());
  add_false_closure(problem, 10, 110, 60);
  EXPECT_THAT(closure_faults(problem), ElementsAre(Fault::closure_gap));
}

TEST(DoctorOfClosures, ASecondCheckUsesTheJudgementThatIsKnown) {
  Problem problem = rounds();
  add_false_closure(problem, 10, 110, 60);
  const methods::ClosureJudgement judged = methods::judge_closures(problem);
  EXPECT_EQ(check_closures(problem, &judged).size(), 1u);
  EXPECT_EQ(check_closures(problem, &judged)[0].evidence, check_closures(problem)[0].evidence);
}

TEST(DoctorOfClosures, StepsThatTheClosuresExclude) {
  const Problem problem = rounds();
  methods::ClosureJudgement judged = methods::judge_closures(problem);
  judged.steps = {{.from = 59, .inflation = 30.0, .metres = 3.2, .degrees = 40.0}};
  const InputFinding found = only(check_closures(problem, &judged), Fault::odometry_step);
  EXPECT_THAT(found.evidence, HasSubstr("59.0 s -> 60.0 s (3.2 m, 40 deg)"));
}

TEST(DoctorOfClosures, InformationOfTheOdometry) {
  Problem problem = rounds();
  scale_information(problem.odometry, 1e6);
  only(check_closures(problem), Fault::information);
}

TEST(DoctorOfClosures, GapsThatSmallVariancesExplainAreNoContradictions) {
  Problem problem = rounds(10.0);
  add_false_closure(problem, 10, 14, 1.2);  // three deviations of four steps and a closure
  EXPECT_THAT(closure_faults(problem), IsEmpty());
  scale_information(problem.odometry, 1e6);
  scale_information(problem.closures, 1e6);
  only(check_closures(problem), Fault::information);
}

}  // namespace
}  // namespace loopbench::test::doctor_closures_test
