/// Records how much of its limit each numerical comparison of the tests uses: with
/// LOOPBENCH_TOLERANCES=FILE, a test program appends one line per call of EXPECT_NEAR or
/// ASSERT_NEAR when it ends: used share of the limit, limit, file and line, and the test case with
/// the largest share. tests/tolerances.sh compares builds by it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "datasets/core/pose.hpp"

namespace loopbench::test {

class UsedTolerances {
 public:
  static UsedTolerances& all() {
    static UsedTolerances out;
    return out;
  }

  void add(const char* file, int line, double difference, double limit) {
    if (path_ == nullptr || !(limit > 0.0)) return;
    const std::lock_guard lock(mutex_);
    Use& use = worst_[{file, line}];
    if (const double share = std::abs(difference) / limit; !(share < use.share)) {
      const auto* info = testing::UnitTest::GetInstance()->current_test_info();
      use = {share, limit, info ? std::string(info->test_suite_name()) + "." + info->name() : ""};
    }
  }

 private:
  struct Use {
    double share = 0.0;  ///< largest difference over its limit [-]
    double limit = 0.0;
    std::string test;
  };

  UsedTolerances() = default;
  ~UsedTolerances() {
    if (path_ == nullptr) return;
    std::ofstream out(path_, std::ios::app);
    for (const auto& [place, use] : worst_) {
      out << use.share << ' ' << use.limit << ' ' << place.first << ':' << place.second << ' '
          << use.test << '\n';
    }
  }

  const char* path_ = std::getenv("LOOPBENCH_TOLERANCES");
  std::mutex mutex_;
  std::map<std::pair<std::string, int>, Use> worst_;
};

/// gtest's comparison with a limit, recorded for its place in the source.
struct NearAt {
  const char* file;
  int line;
  testing::AssertionResult operator()(const char* a_text,
                                      const char* b_text,
                                      const char* limit_text,
                                      double a,
                                      double b,
                                      double limit) const {
    UsedTolerances::all().add(file, line, a - b, limit);
    return testing::internal::DoubleNearPredFormat(a_text, b_text, limit_text, a, b, limit);
  }
};

/// is_close(), recorded for its place in the source.
inline testing::AssertionResult pose_near(
    const char* file, int line, const Pose& a, const Pose& b, double metres, double radians) {
  const double apart = (a.translation - b.translation).norm();
  const double turned = angle_between(a.rotation, b.rotation);
  UsedTolerances::all().add(file, line, apart, metres);
  UsedTolerances::all().add(file, line, turned, radians);
  if (is_close(a, b, metres, radians)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "the poses differ by " << apart << " m (limit " << metres
                                     << ") and " << turned << " rad (limit " << radians << ")";
}

}  // namespace loopbench::test

#undef EXPECT_NEAR
#undef ASSERT_NEAR
#define EXPECT_NEAR(a, b, limit) \
  EXPECT_PRED_FORMAT3((::loopbench::test::NearAt{__FILE__, __LINE__}), a, b, limit)
#define ASSERT_NEAR(a, b, limit) \
  ASSERT_PRED_FORMAT3((::loopbench::test::NearAt{__FILE__, __LINE__}), a, b, limit)
#define EXPECT_POSE_NEAR(...) \
  EXPECT_TRUE(::loopbench::test::pose_near(__FILE__, __LINE__, __VA_ARGS__))
#define ASSERT_POSE_NEAR(...) \
  ASSERT_TRUE(::loopbench::test::pose_near(__FILE__, __LINE__, __VA_ARGS__))
