// A day's work: bag -> trajectories -> doctor -> runs of two systems -> verdict -> LaTeX and PDF ->
// gate, with the real binary.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/formats.hpp"
#include "tests/support/bag_writer.hpp"
#include "tests/support/command.hpp"

namespace loopbench::session_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

/// A path through space with varied speed.
Pose at(double t) {
  return {exp_so3({0, 0, 0.6 * t}) * exp_so3({0.5 * std::sin(0.9 * t), 0.4 * std::cos(t), 0}),
          {4 * std::cos(0.6 * t + 0.2 * std::sin(t)), 3 * std::sin(0.6 * t), std::sin(0.35 * t)}};
}

/// Poses of a system whose clock is `late` [s] behind.
Trajectory estimated(double error, int run, double late) {
  Trajectory out;
  for (double t = 0.5; t < 19.0; t += 0.05) {
    const double wave = error * std::sin(3.0 * t + run);
    out.push_back({1e9 + t - late, at(t) * Pose{Rotation::Identity(), {wave, 0.5 * wave, -wave}}});
  }
  return out;
}

/// The poses of estimated() with `factor` times their errors, which are displacements.
Trajectory with_errors(Trajectory poses, double factor) {
  double t = 0.5;
  for (auto& [stamp, pose] : poses) {
    const Pose truth = at(t);
    pose.translation = truth.translation + factor * (pose.translation - truth.translation);
    t += 0.05;
  }
  return poses;
}

TEST(Session, FromABagToTheGate) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return folder.path() / name; };
  std::vector<std::string> messages;
  for (int i = 0; i < 400; ++i) {
    messages.push_back(
        test::ros1_pose_stamped(1'000'000'000'000'000'000 + i * 50'000'000LL, at(0.05 * i)));
  }
  std::ofstream(path("day.bag"), std::ios::binary) << test::ros1_bag(messages);
  std::filesystem::create_directories(path("fixed"));
  for (int run = 0; run < 10; ++run) {
    const std::string tail = "_run" + std::to_string(run) + ".txt";
    for (const auto& [name, late] : {std::pair{"", 0.2}, {"fixed/", 0.0}}) {
      write_tum(path(name + ("good" + tail)), estimated(0.01 + 0.001 * run, run, late));
      write_tum(path(name + ("bad" + tail)), estimated(0.04 + 0.002 * run, run, late));
    }
  }
  const auto run = [&](const std::string& arguments, int expected = 0) {
    const CommandResult result = loopbench_command(arguments, folder);
    EXPECT_EQ(result.exit_code, expected) << arguments << "\n" << result.out << result.err;
    return result.out;
  };
  run("traj convert bag:day.bag#/pose -o groundtruth.txt");
  EXPECT_THAT(run("doctor groundtruth.txt *_run*.txt", 1), HasSubstr("time_offset"));
  run("doctor groundtruth.txt fixed/*.txt");  // nothing is left to correct
  const std::string verdict =
      run("eval groundtruth.txt fixed/*.txt --sequence day --store results");
  EXPECT_THAT(verdict, ContainsRegex("\n\\| day, good +\\| +\\**0[.0-9]+ ± "));
  EXPECT_THAT(verdict, HasSubstr("good is best: "));
  EXPECT_THAT(run("compare results"), HasSubstr("good is"));
  run("table results --format latex -o table.tex");
  EXPECT_THAT(read_all(path("table.tex")), HasSubstr("tabular"));
  run("report results -o report.html");
  EXPECT_THAT(read_all(path("report.html")), HasSubstr("<h1>Evaluation on day</h1>"));
  run("check results --baseline baseline.json --update --allow-dirty");
  // The next versions of the systems: their new outputs are checked against the old ones.
  for (const auto& [version, factor] : {std::pair{"same", 1.0}, {"better", 0.8}, {"worse", 1.3}}) {
    const std::string name = version;
    std::filesystem::create_directories(path(name));
    for (const auto& file : std::filesystem::directory_iterator(path("fixed"))) {
      write_tum(path(name) / file.path().filename(),
                with_errors(read_trajectory(file.path()), factor));
    }
    run("eval groundtruth.txt " + name + "/*.txt --sequence day --store next_" + name);
    run("check next_" + name + " --baseline baseline.json --allow-dirty", name == "worse" ? 1 : 0);
  }
  run("eval groundtruth.txt fixed/good_run0.txt fixed/good_run1.txt --report two.html --labels "
      "ours");
  const std::string page = read_all(path("two.html"));
  EXPECT_THAT(page, HasSubstr("<h1>Evaluation on " + folder.path().filename().string() + "</h1>"));
  run("eval groundtruth.txt fixed/good_run0.txt --report single.html");
  const std::string single = read_all(path("single.html"));
  EXPECT_THAT(single, HasSubstr("<p>A single method, so no verdicts.</p>"));
  EXPECT_THAT(single, testing::Not(HasSubstr("cannot show a difference")));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">ours</th>"));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme: dark"));
  if (!has_matplotlib()) GTEST_SKIP() << "needs python3-matplotlib";
  run("plot results -o figures --format pdf");
  EXPECT_EQ(read_all(path("figures/01_day_errors.pdf")).substr(0, 5), "%PDF-");
  run("eval groundtruth.txt fixed/good_run0.txt --plot one");
  EXPECT_EQ(read_all(path("one_errors.pdf")).substr(0, 5), "%PDF-");
  EXPECT_EQ(read_all(path("one_axes.png")).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace loopbench::session_test
