#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "metrics/doctor/diagnose.hpp"

namespace loopbench::doctor_time_offset_test {
namespace {

using namespace metrics;

TEST(TimeOffset, IsNotFoundAtAConstantRateOfRotation) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.05);
    const auto rounded = [](double x) { return 1e-9 * std::round(1e9 * x); };
    Trajectory reference, estimate;
    for (int i = 0; i < 200; ++i) {
      const double t = 1000.0 + 0.1 * i, angle = 0.5 * t;
      const Rotation rotation(rounded(std::cos(angle / 2)), 0, 0, rounded(std::sin(angle / 2)));
      const Vector3 p(5 * std::cos(angle), 5 * std::sin(angle), 0.1 * std::sin(3 * angle));
      reference.push_back({t, {rotation.normalized(), p}});
      estimate.push_back(
          {t, {rotation.normalized(), p + Vector3(noise(random), noise(random), noise(random))}});
    }
    for (const InputFinding& found :
         diagnosis(reference, estimate, "reference.txt", "run.txt").findings) {
      EXPECT_NE(found.fault, Fault::time_offset) << seed << ": " << text(found);
    }
  }
}

}  // namespace
}  // namespace loopbench::doctor_time_offset_test
