// b_spline and cubic_spline: basis, derivatives of rotations, curves.
#include "methods/smoothers/interpolating_splines.hpp"

#include <gtest/gtest.h>

#include <random>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/spline/basis.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/smoothers/spline/interpolate.hpp"
#include "tests/support/noisy_paths.hpp"

namespace loopbench::test::interpolating_splines_test {
namespace {

/// Position is a polynomial of the given degree, rotation a polynomial angle about one axis.
auto polynomial(int degree) {
  return [degree](double time) {
    const double s = 0.2 * (time - 1000.0);
    double power = 1.0;
    Vector3 position(1.0, -2.0, 0.5);
    double angle = 0.3;
    for (int k = 1; k <= degree; ++k) {
      power *= s;
      position += power * Vector3(0.5 / k, 0.3 - 0.2 * k, 0.1 * k);
      angle += 0.4 * power / k;
    }
    return Pose{exp_so3({0.2, 0.1, -0.7}) * exp_so3(angle * Vector3(1.0, -2.0, 2.0) / 3.0),
                position};
  };
}

TEST(RotationDerivative, AgreesWithDifferences) {
  const std::array<Rotation, 5> controls{exp_so3({0.1, 0.2, 0.3}),
                                         exp_so3({0.4, 0.0, 0.6}),
                                         exp_so3({0.5, -0.6, 0.9}),
                                         exp_so3({1.5, -0.6, 0.4}),
                                         exp_so3({1.2, -1.6, 0.0})};
  const SplineBasis::Values B{1.0, 0.95, 0.7, 0.3, 0.02, 0.0};
  const RotationDerivative current = rotation_derivative(controls.data(), 5, B);
  constexpr double step = 1e-6;
  for (std::size_t j = 0; j < 5; ++j) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double by) {
        auto moved_controls = controls;
        moved_controls[j] = exp_so3(by * Vector3::Unit(axis)) * moved_controls[j];
        return rotation_derivative(moved_controls.data(), 5, B).rotation;
      };
      const Vector3 numeric = log_so3(moved(step) * moved(-step).conjugate()) / (2.0 * step);
      EXPECT_NEAR((numeric - current.by[j].col(axis)).norm(), 0.0, 1e-8) << j << ", " << axis;
    }
  }
}

TEST(BSpline, PassesThroughTheKeyframesInEveryOrder) {
  for (const std::size_t n : {1u, 2u, 3u, 5u, 6u, 60u}) {
    Trajectory keyframes = hand_held_truth(n);
    for (int order = 2; order <= 6; ++order) {
      SCOPED_TRACE(order);
      const auto curve = smooth<BSplineThrough>(keyframes, {{"order", std::int64_t{order}}});
      expect_close(curve->sample(stamps(keyframes)), keyframes, 1e-11);
    }
  }
}

TEST(BSpline, OfOrderKReproducesPolynomialsOfDegreeKMinusOne) {
  for (int order = 2; order <= 6; ++order) {
    const auto truth = polynomial(order - 1);
    const Trajectory keyframes = sampled_at(uneven(14, 1000.0), truth);
    const auto curve = smooth<BSplineThrough>(keyframes, {{"order", std::int64_t{order}}});
    expect_follows(*curve, keyframes, truth, 1e-9);
  }
}

/// Random walk with uneven stamps, steps up to half a metre and about half a radian.
Trajectory wandering(std::size_t n, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto random_vector = [&] {
    return Vector3(uniform(random), uniform(random), uniform(random));
  };
  Trajectory out{{1000.0, {exp_so3(2.0 * random_vector()), 10.0 * random_vector()}}};
  while (out.size() < n) {
    const auto& [stamp, pose] = out.back();
    const Pose step{exp_so3(0.35 * random_vector()), 0.3 * random_vector()};
    out.push_back({stamp + 0.35 + 0.25 * uniform(random), normalized(pose * step)});
  }
  return out;
}

/// Natural cubic spline of a scalar by its second derivatives M (textbook form): h_{i-1} M_{i-1} +
/// 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (slope_i - slope_{i-1}), M_0 = M_n = 0.
class Textbook {
 public:
  Textbook(std::vector<double> t, std::vector<double> y) : t_(std::move(t)), y_(std::move(y)) {
    const auto n = static_cast<Eigen::Index>(t_.size());
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double before = t_[k] - t_[k - 1], after = t_[k + 1] - t_[k];
      A(i, i - 1) = before;
      A(i, i) = 2.0 * (before + after);
      A(i, i + 1) = after;
      b(i) = 6.0 * ((y_[k + 1] - y_[k]) / after - (y_[k] - y_[k - 1]) / before);
    }
    M_ = A.fullPivLu().solve(b);
  }

  double at(double time) const {
    std::size_t i = 0;
    while (i + 2 < t_.size() && t_[i + 1] <= time) ++i;
    const double h = t_[i + 1] - t_[i];
    const double a = (t_[i + 1] - time) / h, b = (time - t_[i]) / h;
    const auto m = static_cast<Eigen::Index>(i);
    return a * y_[i] + b * y_[i + 1] +
           ((a * a * a - a) * M_(m) + (b * b * b - b) * M_(m + 1)) * h * h / 6.0;
  }

 private:
  std::vector<double> t_, y_;
  Eigen::VectorXd M_;
};

TEST(CubicSpline, PassesThroughTheKeyframes) {
  for (const std::size_t n : {1u, 2u, 3u, 4u, 5u, 200u}) {
    const Trajectory keyframes = wandering(n);
    const auto curve = smooth<CubicSpline>(keyframes);
    EXPECT_EQ(curve->start(), keyframes.front().stamp);
    EXPECT_EQ(curve->end(), keyframes.back().stamp);
    expect_close(curve->sample(stamps(keyframes)), keyframes, 1e-12);
  }
}

TEST(CubicSpline, EqualsTheTextbookNaturalSpline) {
  for (const std::size_t n : {3u, 4u, 30u}) {
    const Trajectory keyframes = wandering(n);
    const auto curve = smooth<CubicSpline>(keyframes);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const StampedPose& pose : keyframes) {
        values.push_back(pose.world_from_body.translation(axis));
      }
      const Textbook textbook(stamps(keyframes), values);
      for (const double time : query_times(keyframes, 49)) {
        EXPECT_NEAR(curve->at(time).translation(axis), textbook.at(time), 1e-11);
      }
    }
  }
}

TEST(CubicSpline, RotationAboutOneAxisIsTheNaturalSplineOfTheAngle) {
  const std::vector<double> times{0.0, 0.4, 1.3, 1.5, 2.6, 3.0};
  const std::vector<double> angles{0.0, 0.3, -0.2, 0.1, 0.9, 1.1};
  const Vector3 axis = Vector3(1.0, -2.0, 2.0) / 3.0;
  Trajectory keyframes;
  for (std::size_t i = 0; i < times.size(); ++i) {
    keyframes.push_back({times[i], {exp_so3(angles[i] * axis), Vector3::Zero()}});
  }
  const auto curve = smooth<CubicSpline>(keyframes);
  const Textbook textbook(times, angles);
  for (const double time : query_times(keyframes, 19)) {
    EXPECT_NEAR((log_so3(curve->at(time).rotation) - textbook.at(time) * axis).norm(), 0.0, 1e-12);
  }
}

/// One-sided finite differences of position and rotation; the sign of h selects the side.
struct Motion {
  Twist first, second;

  Motion(const Curve& curve, double time, double h) {
    const Rotation current = curve.at(time).rotation;
    const auto at = [&](int k) {
      const Pose pose = curve.at(time + k * h);
      return twist(pose.translation, log_so3(current.conjugate() * pose.rotation));
    };
    first = (-3.0 * at(0) + 4.0 * at(1) - at(2)) / (2.0 * h);
    second = (2.0 * at(0) - 5.0 * at(1) + 4.0 * at(2) - at(3)) / (h * h);
  }
};

TEST(CubicSpline, HasNoKinkInSpeedOrAccelerationAndNoAccelerationAtItsEnds) {
  Trajectory keyframes = wandering(14);
  for (StampedPose& pose : keyframes) pose.stamp -= 1000.0;  // reduces rounding in the differences
  const auto curve = smooth<CubicSpline>(keyframes);
  const double h = 1e-4;
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const Motion after(*curve, keyframes[i].stamp, h), before(*curve, keyframes[i].stamp, -h);
    // The error of a one-sided stencil is h^2 times a higher derivative on its own side.
    EXPECT_NEAR((after.first - before.first).head<3>().norm(), 0.0, 1e-5);
    EXPECT_LT((after.second - before.second).head<3>().norm(), 1e-3);
    EXPECT_NEAR((after.first - before.first).tail<3>().norm(), 0.0, 1e-5);
    EXPECT_LT((after.second - before.second).tail<3>().norm(), 5e-3);
  }
  for (const Motion& end : {Motion(*curve, curve->start(), h), Motion(*curve, curve->end(), -h)}) {
    EXPECT_LT(end.second.head<3>().norm(), 1e-3);
    EXPECT_LT(end.second.tail<3>().norm(), 5e-3);
  }
}

TEST(CubicSpline, NeedsFewNewtonStepsForAnySize) {
  for (const std::size_t n : {100u, 100000u}) {
    const Trajectory keyframes = wandering(n);
    std::vector<Rotation> rotations;
    for (const StampedPose& pose : keyframes) rotations.push_back(pose.world_from_body.rotation);
    const auto found = natural_rotation_controls(SplineBasis(4, stamps(keyframes)), rotations);
    ASSERT_TRUE(found.has_value());
    EXPECT_LE(found->iterations, 8);
  }
}

}  // namespace
}  // namespace loopbench::test::interpolating_splines_test
