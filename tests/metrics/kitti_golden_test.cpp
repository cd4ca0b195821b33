/// Results of KITTI's odometry devkit on the same files, digit by digit.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "datasets/formats/text_formats.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::kitti_golden_test {

using namespace metrics;

namespace {

std::string golden(const std::string& name) {
  return std::string(LOOPBENCH_TEST_DATA) + "/golden/" + name;
}

std::vector<Score> drift(const std::string& name) {
  const std::string reference = golden("kitti_gt.txt");
  const std::string estimate = golden("kitti_est.txt");
  const PrintedPoses printed{read_kitti_matrices(reference), read_kitti_matrices(estimate)};
  Evaluation evaluation =
      evaluate(read_trajectory(reference), read_trajectory(estimate), named_protocol(name).rules);
  evaluation.context.printed = &printed;
  return segments(evaluation, {});
}

/// printf's %.9g, the format of the golden file.
std::string nine_digits(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

TEST(KittiGolden, DevkitInFloatToTheLastPrintedDigit) {
  const std::vector<Score> scores = drift("kitti");
  const auto mean = [&](const std::string& relation, const std::string& axis) {
    const double unit = relation == "translation" ? 100.0 : 180.0 / M_PI;
    return nine_digits(find(scores, relation, axis).mean / unit);
  };
  EXPECT_EQ(find(scores, "translation", "all").count, 545u);
  EXPECT_EQ(mean("translation", "all"), "0.0248126276");
  EXPECT_EQ(mean("rotation", "all"), "0.000223467345");

  std::ifstream file(golden("kitti_golden.txt"));
  int lengths = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string len, metres, n, t, translation, r, rotation;
    std::size_t count = 0;
    words >> len >> metres >> n >> count >> t >> translation >> r >> rotation;
    if (len != "len") continue;
    ++lengths;
    EXPECT_EQ(find(scores, "translation", metres + " m").count, count) << line;
    EXPECT_EQ(mean("translation", metres + " m"), translation) << line;
    EXPECT_EQ(mean("rotation", metres + " m"), rotation) << line;
  }
  EXPECT_EQ(lengths, 8);
}

TEST(KittiGolden, TheSameInDouble) {
  const std::vector<Score> scores = drift("kitti-double");
  EXPECT_EQ(find(scores, "translation", "all").count, 545u);
  EXPECT_NEAR(find(scores, "translation", "all").mean, 2.48126254419, 1e-9 * 2.48);
  EXPECT_NEAR(find(scores, "rotation", "all").mean, 0.0128037720163, 1e-9 * 0.0128);
}

TEST(KittiGolden, RotationsMadeOfTheDigitsAgreeLessWell) {
  const Evaluation rigid = evaluate(read_trajectory(golden("kitti_gt.txt")),
                                    read_trajectory(golden("kitti_est.txt")),
                                    named_protocol("kitti-double").rules);
  const double mean = find(segments(rigid, {}), "rotation", "all").mean;
  EXPECT_NEAR(mean, 0.0128037720163, 3e-9 * 0.0128);
  EXPECT_GT(std::abs(mean - 0.0128037720163), 1e-9 * 0.0128);
}

}  // namespace
}  // namespace loopbench::test::kitti_golden_test
