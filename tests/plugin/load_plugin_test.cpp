#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/sweep/catalogue/plugins.hpp"
#include "harness/sweep/store/read.hpp"
#include "methods/online/online.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/command.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench {

using namespace methods;
using namespace harness;

namespace {

using testing::HasSubstr;

const std::filesystem::path kOutside = LOOPBENCH_OUTSIDE;
const std::filesystem::path kOutsideGcc = LOOPBENCH_OUTSIDE_GCC;

/// Checks that the error message contains the file and the reason.
void expect_refused(const std::filesystem::path& object, const std::string& reason) {
  const std::string why = refusal_of<InputError>([&] { load_plugin(object); });
  EXPECT_THAT(why, testing::StartsWith("plugin " + object.string() + ": "));
  EXPECT_THAT(why, HasSubstr(reason));
}

/// Its methods, in order.
std::vector<MethodEntry> methods_of(const std::filesystem::path& object) {
  std::vector<MethodEntry> out;
  for (const PluginEntry& entry : load_plugin(object)) {
    if (const auto* method = std::get_if<MethodEntry>(&entry)) out.push_back(*method);
  }
  return out;
}

TEST(LoadPlugin, BringsItsMethodsInOrder) {
  const std::vector<MethodEntry> entries = methods_of(kOutside / "half_way.so");
  ASSERT_EQ(entries.size(), 5u);
  EXPECT_EQ(entries[0].name, "half_way");
  EXPECT_EQ(entries[0].kind, Kind::corrector);
  EXPECT_EQ(entries[1].kind, Kind::smoother);
  EXPECT_EQ(entries[2].kind, Kind::joint);
  ASSERT_EQ(entries[0].options.size(), 1u);
  EXPECT_EQ(entries[0].options[0].name, "share");
  EXPECT_EQ(entries[0].options[0].rule, "0 <= share <= 1");
}

TEST(LoadPlugin, ItsDatasetMethodAndMetricMakeASweep) {
  const TemporaryFolder folder;
  folder.file("c.yaml",
              "plugins: ['" + (kOutside / "half_way.so").string() +
                  "']\ndatasets: [{dataset: straight, keyframes: 7}]\n"
                  "methods: [raw, lifted, thrower]\n"
                  "metrics: [{metric: max_height, above: 0.5}, height, unprintable]\n"
                  "protocol: {align: none}\ntimes: keyframes\n");
  const CommandResult ran = loopbench_command("run c.yaml --out r", folder);
  std::map<std::string, double> height;
  std::map<std::string, double> mean;
  for (const Record& record : read_records(folder.path() / "r")) {
    if (record.kind->metric == "max_height") height[record.cell->method] = record.statistics.rmse;
    if (record.kind->metric == "height") mean[record.cell->method] = record.statistics.mean;
    if (record.kind->metric == "unprintable") {
      EXPECT_THAT(record.why, HasSubstr("has byte 0x1b"));
    }
  }
  EXPECT_EQ(height["raw"], 1.5) << ran.err;
  EXPECT_EQ(height["lifted"], 2.5);
  EXPECT_EQ(mean["lifted"], 3.0);
  EXPECT_THAT(loopbench_command("run c.yaml --out r", folder).out,
              HasSubstr("of them in earlier runs)"));
  folder.file("c.yaml",
              "plugins: absent.so\ndatasets: [simulated]\nmethods: [raw]\nmetrics: [ate]\n");
  EXPECT_THAT(loopbench_command("run c.yaml", folder).err, HasSubstr("absent.so: "));
  folder.file("c.yaml", "plugins: {a: 1}\ndatasets: [simulated]\nmethods: [raw]\nmetrics: [ate]\n");
  EXPECT_THAT(loopbench_command("run c.yaml", folder).err, HasSubstr("c.yaml:1: plugins: "));
}

TEST(LoadPlugin, ItsCorrectorAndSmootherRunInOurPipeline) {
  const std::vector<MethodEntry> entries = methods_of(kOutside / "half_way.so");
  Stage first = entries[0].make({{"share", 1.0}});
  Stage second = entries[1].make({});
  const auto method = compose(std::get<std::unique_ptr<const Corrector>>(std::move(first)),
                              std::get<std::unique_ptr<const Smoother>>(std::move(second)));
  const Problem problem = test::circle();
  Report report;
  const auto curve = method->estimate(problem, report);
  const Edge& loop = problem.closures.back();
  EXPECT_POSE_NEAR(curve->at(curve->end()),
                   problem.keyframes[loop.from].world_from_body * loop.from_from_to,
                   1e-12,
                   1e-12);
  EXPECT_THROW(curve->at(curve->end() + 1.0), std::out_of_range);
  Problem open = problem;
  open.closures.clear();
  EXPECT_EQ(method->why_declined(open), "no closure to go half way to");
}

TEST(LoadPlugin, ItsIncrementalMethodIsReplayed) {
  const std::vector<MethodEntry> entries = methods_of(kOutside / "half_way.so");
  Stage steps = entries[3].make({});
  const auto method = Online({}).replayed(
      compose(std::get<std::unique_ptr<const Corrector>>(std::move(steps)), nullptr));
  const Problem problem = test::circle();
  Report report;
  const auto curve = method->estimate(problem, report);
  EXPECT_EQ(test::count(report, "own_updates"), test::count(report, "updates"));
  EXPECT_NEAR(curve->at(curve->end()).translation.z(),
              problem.keyframes.back().world_from_body.translation.z() +
                  static_cast<double>(problem.closures.size()),
              1e-12);
}

TEST(LoadPlugin, ExceptionsCrossTheFence) {
  const std::vector<MethodEntry> entries = methods_of(kOutside / "half_way.so");
  EXPECT_THROW(entries[0].make({{"shere", 1.0}}), OptionError);
  const Stage stage = entries[2].make({});
  Report report;
  const auto& method = std::get<std::unique_ptr<const Estimator>>(stage);
  EXPECT_EQ(refusal_of<std::runtime_error>([&] { method->estimate(test::circle(), report); }),
            "thrown inside the plugin");
}

TEST(LoadPlugin, MayBeLoadedTwice) {
  EXPECT_EQ(load_plugin(kOutside / "half_way.so").size(),
            load_plugin(kOutside / "half_way.so").size());
}

TEST(LoadPlugin, AcceptsAnotherCompiler) {
  if (!std::filesystem::exists(kOutsideGcc / "half_way.so")) GTEST_SKIP() << "needs g++";
  const std::vector<MethodEntry> entries = methods_of(kOutsideGcc / "half_way.so");
  ASSERT_EQ(entries.size(), 5u);
  const Problem problem = test::circle();
  Report report;
  const auto curve_of = [&](const MethodEntry& entry) {
    const Stage stage = entry.make({});
    return std::get<std::unique_ptr<const Smoother>>(stage)->smooth(problem, report);
  };
  const auto curve = curve_of(entries[1]);
  const auto same = curve_of(methods_of(kOutside / "half_way.so")[1]);
  const double middle = 0.5 * (curve->start() + curve->end());
  EXPECT_EQ(curve->at(middle).translation, same->at(middle).translation);
  EXPECT_THROW(curve->at(curve->end() + 1.0), std::out_of_range);
  EXPECT_THROW(entries[0].make({{"shere", 1.0}}), OptionError);
}

TEST(LoadPlugin, RefusesWhatItCannotCall) {
  expect_refused(kOutside / "misaligned.so",
                 "was built with EIGEN_MAX_ALIGN_BYTES = 64, expected " +
                     std::to_string(EIGEN_MAX_ALIGN_BYTES));
  expect_refused(kOutside / "outdated.so", "was built for plugin interface 1, this program has 14");
  expect_refused(kOutside / "silent.so", "has no LOOPBENCH_PLUGIN line");
  expect_refused(kOutside / "nowhere.so", "No such file");
  const auto path = kOutside / "no_object.so";
  std::ofstream(path) << "not a shared object\n";
  expect_refused(path, "no_object.so: ");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace loopbench
