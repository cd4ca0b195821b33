#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "harness/calibrate/calibration_text.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/config/read_sweep.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::calibrate_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

/// Edges of different duration, length and rotation, with errors drawn from a known model.
CalibrationResiduals drawn(std::uint64_t seed,
                           std::size_t edges,
                           double noise_t_metre,
                           double noise_r_radian,
                           double drift_r_metre) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> unit;
  std::uniform_real_distribution<double> share(0.1, 1.0);
  Vector3 rate;
  for (int axis = 0; axis < 3; ++axis) rate[axis] = drift_r_metre * unit(random);
  CalibrationResiduals out{"drawn " + std::to_string(seed), false, {}};
  for (std::size_t i = 0; i < edges; ++i) {
    const double dt = share(random);
    const double d = 10.0 * share(random) * share(random);
    const double angle = share(random) * share(random);
    EdgeError edge{{1.0, dt, d, angle, d * d / dt}, Twist::Zero()};
    for (int axis = 0; axis < 3; ++axis) {
      edge.error[axis] = std::sqrt(noise_t_metre * d) * unit(random);
      edge.error[3 + axis] = std::sqrt(noise_r_radian * angle) * unit(random) + rate[axis] * d;
    }
    out.edges.push_back(edge);
  }
  return out;
}

double value_of(const NestedModel& model, const std::string& option) {
  for (const auto& [name, value] : options_of(model)) {
    if (name == option) return value;
  }
  return std::nan("");
}

const NestedModel& model(const std::vector<NestedModel>& models, const std::string& method) {
  for (const NestedModel& r : models) {
    if (r.method == method) return r;
  }
  throw std::runtime_error("no rung " + method);
}

TEST(Calibrate, FindsOneVarianceInClosedForm) {
  // Errors 1, 2 on edges of 1 and 4 m, one variance per metre: mean of 1/1 and 4/4, by hand 1.
  CalibrationResiduals two{"two", true, {}};
  two.edges.push_back({{1, 1, 1, 1, 1}, twist({1, 1, 0}, {0, 0, 1})});
  two.edges.push_back({{1, 1, 4, 1, 1}, twist({2, 2, 0}, {0, 0, 1})});
  const Rates rates = fit_rates(Component::translation, {Regressor::distance}, {}, {two});
  EXPECT_NEAR(rates.noise_variance[0], 1.0, 1e-9);
  // Four errors with variances 1, 1, 4, 4, each of one standard deviation.
  EXPECT_NEAR(log_likelihood(rates, {two}),
              -0.5 * (4.0 + 2.0 * std::log(4.0) + 4.0 * std::log(2.0 * std::numbers::pi)),
              1e-9);
}

TEST(Calibrate, LikelihoodIsThatOfTheDenseNormalDensity) {
  const CalibrationResiduals some = drawn(3, 12, 0.01, 1e-4, 1e-3);
  Rates rates{Component::rotation,
              {Regressor::time, Regressor::rotation},
              {Regressor::distance},
              {2e-4, 1e-4},
              {1e-6}};
  double wanted = 0.0;
  for (int axis = 3; axis < 6; ++axis) {
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(12, 12);
    Eigen::VectorXd e(12);
    for (int i = 0; i < 12; ++i) {
      const auto& a = some.edges[static_cast<std::size_t>(i)];
      e[i] = a.error[axis];
      C(i, i) += 2e-4 * a.regressors[1] + 1e-4 * a.regressors[3];
      for (int j = 0; j < 12; ++j) {
        C(i, j) += 1e-6 * a.regressors[2] * some.edges[static_cast<std::size_t>(j)].regressors[2];
      }
    }
    wanted -= 0.5 * (e.dot(C.ldlt().solve(e)) + std::log((C * 1e4).determinant()) -
                     12 * std::log(1e4) + 12 * std::log(2.0 * std::numbers::pi));
  }
  EXPECT_NEAR(log_likelihood(rates, {some}), wanted, 1e-6);
}

TEST(Calibrate, RecoversTheModelItsEdgesWereDrawnFrom) {
  std::vector<CalibrationResiduals> sequences;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    sequences.push_back(drawn(seed, 150, 4e-4, 1e-4, 2e-3));
  }
  const std::vector<NestedModel> models = fit_nested_models(sequences);
  const NestedModel& best = model(models, "motion_drift");
  // 1800 errors: a variance is estimated to about 3 %, split among three terms to about 15 %.
  EXPECT_NEAR(value_of(best, "noise.t.per_metre"), 4e-4, 0.6e-4);
  EXPECT_NEAR(value_of(best, "noise.r.per_radian"), 1e-4, 0.15e-4);
  EXPECT_LT(value_of(best, "noise.t.per_second"), 1e-4);
  // 12 draws of a rate: its standard deviation is estimated to about 20 %, split among the terms.
  EXPECT_NEAR(value_of(best, "drift.r.per_metre"), 2e-3, 0.8e-3);
  EXPECT_LT(value_of(best, "drift.t.per_metre"), 5e-4);
  // The likelihood increases only for terms that the data contain.
  const auto held_out = [&](const char* method, int component) {
    return model(models, method).held_out[component].value();
  };
  EXPECT_GT(held_out("motion_drift_distance", 0), held_out("motion_drift_const", 0) + 0.05);
  EXPECT_GT(held_out("motion_drift", 1), held_out("motion_drift_rotation", 1) + 0.1);

  const auto intervals = bootstrap(best, sequences, 10, 10, 1);
  const auto options = options_of(best);
  ASSERT_EQ(intervals.size(), options.size());
  for (std::size_t j = 0; j < options.size(); ++j) {
    EXPECT_LE(intervals[j].low, intervals[j].high) << options[j].first;
    if (options[j].first == "noise.t.per_metre") {
      EXPECT_LT(intervals[j].low, 4e-4);
      EXPECT_GT(intervals[j].high, 4e-4);
    }
  }
}

TEST(Calibrate, ComposesEdgesAndGathersTheirMotion) {
  // Four steps of 1 m, each measured 0.1 m too long.
  Sequence sequence;
  for (int i = 0; i <= 4; ++i) {
    const auto place = [&](double x) {
      return StampedPose{double(i), {Rotation::Identity(), Vector3(x, 0, 0)}};
    };
    sequence.reference.push_back(place(i));
    sequence.problem.keyframes.push_back(place(1.1 * i));
    if (i == 0) continue;
    sequence.problem.odometry.push_back({std::size_t(i - 1),
                                         std::size_t(i),
                                         {Rotation::Identity(), Vector3(1.1, 0, 0)},
                                         Matrix6::Identity()});
  }
  const CalibrationResiduals out = residuals(sequence, "straight", 2);
  ASSERT_EQ(out.edges.size(), 2u);
  EXPECT_NEAR(out.edges[0].error[0], -0.2, 1e-12);
  EXPECT_NEAR(out.edges[0].regressors[2], 2.2, 1e-12);
  EXPECT_NEAR(out.edges[0].regressors[1], 2.0, 1e-12);
  sequence.reference.clear();
  EXPECT_THROW(residuals(sequence, "straight", 2), InputError);
}

TEST(Calibrate, WritesWhatAConfigTakesOver) {
  Calibration calibration;
  calibration.config = "c.yaml";
  calibration.sequences = {drawn(1, 40, 4e-4, 1e-4, 2e-3)};
  calibration.sources = {"reference:01", "noise:02"};
  calibration.not_trained_on = {"other \"one\""};
  calibration.models = fit_nested_models(calibration.sequences);
  for (const NestedModel& r : calibration.models) {
    calibration.intervals.push_back(bootstrap(r, calibration.sequences, 5, 2, 1));
  }
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "learnt.yaml") << calibration_yaml(calibration);
  const auto parse = [&](const std::string& entry) {
    return parse_sweep(
        "datasets: [{dataset: simulated}]\nmethods:\n  - " + entry + "\nmetrics: [ate]\n",
        folder.path() / "c.yaml",
        catalogue({}));
  };
  const Sweep sweep =
      parse("{method: motion_drift + polyline, calibration: learnt.yaml, noise.t.per_metre: 0.5}");
  const Params& options = sweep.methods[0].stages[0].options;
  EXPECT_EQ(options.at("noise.t.per_metre"), Param(0.5));  // the entry overrides the file
  EXPECT_EQ(options.size(), options_of(calibration.models.back()).size());
  EXPECT_TRUE(sweep.methods[0].stages[1].options.empty());
  EXPECT_EQ(sweep.methods[0].label, "motion_drift + polyline (noise.t.per_metre=0.5)");
  EXPECT_EQ(sweep.methods[0].trained_on.calibration, "learnt.yaml");
  EXPECT_EQ(sweep.methods[0].trained_on.labels, std::vector<std::string>{"drawn 1"});
  EXPECT_EQ(sweep.methods[0].trained_on.sources, calibration.sources);

  const auto why = [&](const std::string& entry) -> std::string {
    try {
      parse(entry);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(why("{method: dual, calibration: learnt.yaml}").find("has no values for dual"),
            std::string::npos);
  EXPECT_NE(why("{method: motion_drift, calibration: lost.yaml}").find("c.yaml:3: calibration:"),
            std::string::npos);
}

}  // namespace
}  // namespace loopbench::calibrate_test
