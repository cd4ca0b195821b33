// Smoothers that weigh closeness against bending: smoothing_spline, trend_filter.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <random>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/cubic_spline.hpp"
#include "methods/smoothers/penalised/lattice.hpp"
#include "methods/smoothers/penalised/trend.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/smoothing_spline.hpp"
#include "methods/smoothers/trend_filter.hpp"
#include "tests/support/problems.hpp"

namespace loopbench {
namespace {

using namespace test;

const std::vector<double> kTwelve{0.0, 0.3, 0.5, 1.1, 1.3, 2.0, 2.2, 2.9, 3.1, 3.5, 4.2, 4.4};

std::vector<Vector3> wavy(const std::vector<double>& stamps) {
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double s = stamps[i];
    const double noise = 0.1 * std::sin(37.0 * static_cast<double>(i));
    out.push_back(Vector3(std::sin(s), 0.5 * s, std::cos(2.0 * s)) + noise * Vector3(1, -2, 0.5));
  }
  return out;
}

/// White noise of sigma on positions and, a tenth of it, on attitudes.
Trajectory shaken(Trajectory keyframes, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  const auto any = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  for (auto& [stamp, pose] : keyframes) {
    pose.translation += any();
    pose.rotation = (pose.rotation * exp_so3(0.1 * any())).normalized();
  }
  return keyframes;
}

double rms_error(const Curve& curve, const Trajectory& truth) {
  double sum = 0.0;
  for (const auto& [stamp, pose] : truth) {
    sum += (curve.at(stamp).translation - pose.translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

template <class T>
std::unique_ptr<const Curve> smooth(const Trajectory& keyframes,
                                    const Params& params = {},
                                    Report* report = nullptr) {
  Report own;
  Problem problem;
  problem.keyframes = keyframes;
  return T(with(typename T::Options{}, params)).smooth(problem, report ? *report : own);
}

double count(const Report& report, const std::string& name) {
  for (const Count& each : report.counts) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << "no count " << name;
  return std::nan("");
}

/// The hat matrix in full: A = (I + lambda Q R^-1 Q')^-1 (Green & Silverman 1994, 2.3.3).
Eigen::MatrixXd hat_matrix(const std::vector<double>& t, double lambda) {
  const auto n = static_cast<Eigen::Index>(t.size());
  Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n, n - 2), R = Eigen::MatrixXd::Zero(n - 2, n - 2);
  for (Eigen::Index j = 0; j + 2 < n; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double before = t[i + 1] - t[i], after = t[i + 2] - t[i + 1];
    Q(j, j) = 1.0 / before;
    Q(j + 1, j) = -1.0 / before - 1.0 / after;
    Q(j + 2, j) = 1.0 / after;
    R(j, j) = (before + after) / 3.0;
    if (j + 3 < n) R(j, j + 1) = R(j + 1, j) = after / 6.0;
  }
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  return (I + lambda * Q * R.inverse() * Q.transpose()).inverse();
}

TEST(Reinsch, AgreesWithTheDenseComputationForTwelvePoints) {
  const std::vector<Vector3> y = wavy(kTwelve);
  Eigen::MatrixXd Y(12, 3);
  for (int i = 0; i < 12; ++i) Y.row(i) = y[static_cast<std::size_t>(i)];
  const Reinsch reinsch(kTwelve);
  double offset = std::nan("");
  for (const double lambda : {1e-4, 1e-2, 1.0, 100.0}) {
    const Reinsch::Fit fit = reinsch.fit(y, lambda);
    const Eigen::MatrixXd A = hat_matrix(kTwelve, lambda);
    const Eigen::MatrixXd I_A = Eigen::MatrixXd::Identity(12, 12) - A;
    const Eigen::MatrixXd X = A * Y;
    for (int i = 0; i < 12; ++i) {
      EXPECT_LT((X.row(i).transpose() - fit.values[static_cast<std::size_t>(i)]).norm(), 1e-9);
    }
    EXPECT_NEAR(fit.free, I_A.trace(), 1e-8);
    const double residual = (I_A * Y).squaredNorm();
    EXPECT_NEAR(fit.residual.sum(), residual, 1e-9 * residual + 1e-12);
    const double energy = (Y.transpose() * I_A * Y).trace();
    EXPECT_NEAR(fit.energy.sum(), energy, 1e-8);
    const double gcv = 12.0 * residual / std::pow(I_A.trace(), 2);
    EXPECT_NEAR(score(Criterion::gcv, fit, 12), gcv, 1e-7 * gcv);
    // det+ is the product of the ten eigenvalues that are not zero.
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(I_A).eigenvalues();
    const double reml = 10.0 * std::log(energy) - values.tail(10).array().log().sum();
    const double difference = score(Criterion::reml, fit, 12) - reml;
    if (std::isnan(offset)) offset = difference;  // the constant of the stamps
    EXPECT_NEAR(difference, offset, 1e-6);
  }
}

TEST(Reinsch, GoesFromInterpolationToTheStraightLine) {
  const std::vector<Vector3> y = wavy(kTwelve);
  const Reinsch reinsch(kTwelve);
  const Reinsch::Fit rough = reinsch.fit(y, 1e-12);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_LT((rough.values[i] - y[i]).norm(), 1e-8);
  EXPECT_NEAR(12.0 - rough.free, 12.0, 1e-6);

  const Reinsch::Fit stiff = reinsch.fit(y, 1e10);
  Eigen::MatrixXd T(12, 2), Y(12, 3);
  for (int i = 0; i < 12; ++i) {
    T.row(i) << 1.0, kTwelve[static_cast<std::size_t>(i)];
    Y.row(i) = y[static_cast<std::size_t>(i)];
  }
  const Eigen::MatrixXd line = T * (T.transpose() * T).inverse() * T.transpose() * Y;
  for (int i = 0; i < 12; ++i) {
    EXPECT_LT((line.row(i).transpose() - stiff.values[static_cast<std::size_t>(i)]).norm(), 1e-6);
  }
  EXPECT_NEAR(12.0 - stiff.free, 2.0, 1e-6);
}

TEST(Lattice, FindsTheLeastOfAValley) {
  for (const int at : {-20, -3, 0, 7, 31}) {
    EXPECT_EQ(least_on_lattice(-20, 31, 8, [&](int k) { return 1.0 + std::abs(k - at); }), at);
  }
}

TEST(Unrolled, ASteadyTurnIsAStraightLine) {
  std::vector<Rotation> turn;
  const Vector3 rate(0.3, -0.5, 0.8);
  for (int i = 0; i < 20; ++i) turn.push_back(exp_so3({0.4, 1.0, -2.0}) * exp_so3(i * rate));
  const Unrolled path(turn);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_LT((path.flattened(i, turn[i]) - static_cast<double>(i) * rate).norm(), 1e-12);
  }
  EXPECT_LT(angle_between(path.rolled(3, 0.25, 3.25 * rate), turn[3] * exp_so3(0.25 * rate)),
            1e-12);
}

TEST(Unrolled, IsUndoneByRolling) {
  const Trajectory path = hand_held_truth(30);
  std::vector<Rotation> base, near;
  for (const StampedPose& pose : path) {
    base.push_back(pose.world_from_body.rotation);
    near.push_back(base.back() * exp_so3({0.2, -0.1, 0.3}));
  }
  const Unrolled flat(base);
  for (std::size_t i = 0; i < base.size(); ++i) {
    EXPECT_LT(angle_between(flat.rolled(i, 0.0, flat.flattened(i, near[i])), near[i]), 1e-12);
    if (i == 0) continue;  // reached from the interval before as from the one behind
    EXPECT_LT(angle_between(flat.rolled(i - 1, 1.0, flat.flattened(i, near[i])), near[i]), 1e-12);
  }
}

TEST(SmoothingSpline, ReproducesUniformMotionWhateverItsStiffness) {
  const auto truth = [](double time) {
    return Pose{exp_so3({0.3, 0.1, -1.0}) * exp_so3(time * Vector3(0.9, -1.5, 1.2)),
                Vector3(5.0, -2.0, 1.0) + time * Vector3(0.4, 0.3, -0.1)};
  };
  Trajectory keyframes;
  for (const double stamp : kTwelve) keyframes.push_back({stamp, truth(stamp)});
  for (const Params& params : {Params{}, Params{{"lambda_t", 1e3}, {"lambda_r", 1e3}}}) {
    const auto curve = smooth<SmoothingSpline>(keyframes, params);
    for (double time = 0.0; time <= 4.4; time += 0.05) {
      EXPECT_TRUE(is_close(curve->at(time), truth(time), 1e-9, 1e-9)) << time;
    }
  }
}

TEST(SmoothingSpline, WithLittleStiffnessIsTheNaturalCubicSpline) {
  const Trajectory keyframes = hand_held_truth(30);
  const auto curve = smooth<SmoothingSpline>(keyframes, {{"lambda_t", 1e-12}, {"lambda_r", 1e-12}});
  const auto cubic = smooth<CubicSpline>(keyframes);
  for (double time = keyframes.front().stamp; time < keyframes.back().stamp; time += 0.05) {
    EXPECT_LT((curve->at(time).translation - cubic->at(time).translation).norm(), 1e-8);
    // Two different curves on SO(3) through the same attitudes.
    EXPECT_LT(angle_between(curve->at(time).rotation, cubic->at(time).rotation), 5e-3);
  }
  for (const auto& [stamp, pose] : keyframes) {
    EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-8, 1e-8));
  }
}

TEST(SmoothingSpline, StiffItTurnsSteadily) {
  const Trajectory keyframes = shaken(hand_held_truth(20), 0.05, 3);
  Report report;
  const auto curve =
      smooth<SmoothingSpline>(keyframes, {{"lambda_t", 1e9}, {"lambda_r", 1e9}}, &report);
  EXPECT_NEAR(count(report, "free_r"), 2.0, 1e-3);
  const double t = keyframes.front().stamp + 1.0;
  const auto turn = [&](double from) {
    return log_so3(curve->at(from).rotation.conjugate() * curve->at(from + 0.5).rotation);
  };
  EXPECT_LT((turn(t) - turn(t + 2.0)).norm(), 1e-4);
  EXPECT_GT(turn(t).norm(), 0.01);
}

TEST(SmoothingSpline, RemovesAFifthOrMoreOfWhiteNoise) {
  for (const char* criterion : {"gcv", "reml"}) {
    double before = 0.0, after = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Trajectory truth = hand_held_truth(120);
      const Trajectory keyframes = shaken(truth, 0.02, seed);
      before += rms_error(*smooth<CubicSpline>(keyframes), truth);
      after += rms_error(
          *smooth<SmoothingSpline>(keyframes, {{"criterion", std::string(criterion)}}), truth);
    }
    EXPECT_LT(after, 0.8 * before) << criterion;
  }
}

TEST(SmoothingSpline, HasNoKinkInSpeedOrTurn) {
  const Trajectory keyframes = shaken(hand_held_truth(20), 0.02, 5);
  Report report;
  const auto curve = smooth<SmoothingSpline>(keyframes, {}, &report);
  EXPECT_TRUE(report.notes.empty());
  constexpr double h = 1e-5;
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const double t = keyframes[i].stamp;
    const Pose here = curve->at(t);
    const auto turn = [&](double side) {
      return Vector3(log_so3(here.rotation.conjugate() * curve->at(t + side).rotation) / side);
    };
    EXPECT_LT((turn(h) - turn(-h)).norm(), 1e-3) << i;
  }
}

TEST(SmoothingSpline, EachAxisMayHaveItsOwnStiffness) {
  Report report;
  const Trajectory keyframes = shaken(hand_held_truth(60), 0.02, 5);
  smooth<SmoothingSpline>(keyframes, {{"axes", std::string("each")}}, &report);
  for (const char* name : {"lambda_x", "lambda_y", "lambda_z"}) EXPECT_GT(count(report, name), 0.0);
}

TEST(SmoothingSpline, DeclinesTwoKeyframes) {
  EXPECT_EQ(SmoothingSpline({}).declines(short_circle(2)), "fewer than 3 keyframes bend nowhere");
  EXPECT_EQ(SmoothingSpline({}).declines(short_circle(3)), std::nullopt);
}

/// Forward, a stop, then sideways turning: bends at 12, 20 and 29 of 40.
Trajectory stop_and_go() {
  Trajectory out;
  Vector3 place(1.0, 2.0, 0.0);
  double angle = 0.0, time = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    out.push_back({time, turned_about_z(angle, place)});
    const double step = i % 3 == 0 ? 0.2 : 0.5;
    time += step;
    if (i < 12) place += step * Vector3(1.0, 0.0, 0.1);
    if (i >= 20) place += step * Vector3(0.0, -0.7, 0.0);
    if (i >= 29) angle += 0.4 * step;
  }
  return out;
}

TEST(TrendFilter, RecoversPiecewiseStraightMotion) {
  const Trajectory truth = stop_and_go();
  Report report;
  const auto curve = smooth<TrendFilter>(truth, {{"refit", true}}, &report);
  EXPECT_TRUE(report.notes.empty());
  EXPECT_EQ(count(report, "kinks_t"), 2.0);
  EXPECT_EQ(count(report, "kinks_r"), 1.0);
  for (const auto& [stamp, pose] : truth) {
    EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-9, 1e-9)) << stamp;
  }
}

TEST(TrendFilter, FindsTheBendsUnderNoiseAndBeatsTheKeyframes) {
  double before = 0.0, after = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Trajectory truth = stop_and_go();
    const Trajectory keyframes = shaken(truth, 0.02, seed);
    Report report;
    const auto curve = smooth<TrendFilter>(keyframes, {{"refit", true}}, &report);
    before += rms_error(Polyline(keyframes), truth);
    after += rms_error(*curve, truth);
    EXPECT_LE(count(report, "kinks_t"), 8.0);
  }
  EXPECT_LT(after, 0.6 * before);
}

TEST(TrendFilter, TakesOffNoiseFromACurvedPathToo) {
  double before = 0.0, after = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Trajectory truth = hand_held_truth(120);
    const Trajectory keyframes = shaken(truth, 0.02, seed);
    Report report;
    before += rms_error(Polyline(keyframes), truth);
    after += rms_error(*smooth<TrendFilter>(keyframes, {}, &report), truth);
    EXPECT_TRUE(report.notes.empty());
  }
  EXPECT_LT(after, 0.9 * before);
}

TEST(TrendFilter, KinkOfThreePointsIsSoftThresholdedAsWorkedByHand) {
  // y = (0, 1, 0), unit steps: D = (1, -2, 1), D y = -2, D D' = 6. The line is reached at
  // lambda = 2 / 6; below, x = y + lambda D' = (lambda, 1 - 2 lambda, lambda).
  const Trend trend({0.0, 1.0, 2.0});
  const std::vector<Vector3> y{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  EXPECT_NEAR(trend.straight_from(y), 1.0 / 3.0, 1e-15);
  for (const double lambda : {0.05, 0.2, 0.5}) {
    const auto fit = trend.fit(y, lambda, {.tolerance = 1e-10});
    const double expected = std::min(lambda, 1.0 / 3.0);
    EXPECT_TRUE(fit.converged);
    EXPECT_NEAR(fit.values[0].x(), expected, 1e-8);
    EXPECT_NEAR(fit.values[1].x(), 1.0 - 2.0 * expected, 1e-8);
    EXPECT_EQ(fit.kinks.size(), lambda < 1.0 / 3.0 ? 1u : 0u);
  }
  EXPECT_NEAR(trend.refitted(y, {})[1].x(), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(trend.refitted(y, {1})[1].x(), 1.0, 1e-15);
}

TEST(TrendFilter, KeepsTheOptimalityConditions) {
  // y - x = D' v with |v_j| <= lambda, and v_j = lambda z_j / |z_j| where D x = z is not zero.
  const std::vector<Vector3> y = wavy(kTwelve);
  const Trend trend(kTwelve);
  const double lambda = 0.2 * trend.straight_from(y);
  const auto fit = trend.fit(y, lambda, {.tolerance = 1e-11});
  ASSERT_TRUE(fit.converged);
  std::vector<double> times = kTwelve;
  for (double& time : times) time /= trend.interval();
  const SlopeChange D(times);
  std::vector<Vector3> missed = y;
  for (std::size_t i = 0; i < 12; ++i) missed[i] -= fit.values[i];
  std::vector<Vector3> v = D.of(missed);
  PentadiagonalFactor(D.outer()).solve(v);
  const std::vector<Vector3> bends = D.of(fit.values);
  for (std::size_t j = 0; j < v.size(); ++j) {
    EXPECT_LE(v[j].norm(), lambda * (1.0 + 1e-6));
    const bool kink = std::ranges::find(fit.kinks, j + 1) != fit.kinks.end();
    if (kink) {
      EXPECT_LT((v[j] - lambda * bends[j].normalized()).norm(), 1e-5 * lambda);
    }
  }
  EXPECT_GT(fit.kinks.size(), 0u);
  EXPECT_LT(fit.kinks.size(), 10u);
}

}  // namespace
}  // namespace loopbench
