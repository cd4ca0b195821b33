#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "datasets/core/error.hpp"
#include "harness/catalogue/plugins.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/problems.hpp"

namespace loopbench {

using namespace methods;
using namespace harness;

namespace {

const std::filesystem::path kOutside = LOOPBENCH_OUTSIDE;

/// Checks that the error message contains the file and the reason.
void expect_refused(const std::filesystem::path& object, const std::string& reason) {
  try {
    load_plugin(object);
    ADD_FAILURE() << object << " was not refused";
  } catch (const InputError& error) {
    const std::string why = error.what();
    EXPECT_TRUE(why.starts_with("plugin " + object.string() + ": ")) << why;
    EXPECT_NE(why.find(reason), std::string::npos) << why;
  }
}

TEST(LoadPlugin, BringsItsMethodsInOrder) {
  const std::vector<MethodEntry> entries = load_plugin(kOutside / "half_way.so");
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].name, "half_way");
  EXPECT_EQ(entries[0].kind, Kind::corrector);
  EXPECT_EQ(entries[1].kind, Kind::smoother);
  EXPECT_EQ(entries[2].kind, Kind::joint);
  ASSERT_EQ(entries[0].options.size(), 1u);
  EXPECT_EQ(entries[0].options[0].name, "share");
  EXPECT_EQ(entries[0].options[0].rule, "0 <= share <= 1");
}

TEST(LoadPlugin, ItsCorrectorAndSmootherRunInOurPipeline) {
  const std::vector<MethodEntry> entries = load_plugin(kOutside / "half_way.so");
  Stage first = entries[0].make({{"share", 1.0}});
  Stage second = entries[1].make({});
  const auto method = compose(std::get<std::unique_ptr<const Corrector>>(std::move(first)),
                              std::get<std::unique_ptr<const Smoother>>(std::move(second)));
  const Problem problem = test::circle();
  Report report;
  const auto curve = method->estimate(problem, report);
  const Edge& loop = problem.closures.back();
  EXPECT_TRUE(is_close(curve->at(curve->end()),
                       problem.keyframes[loop.from].world_from_body * loop.from_from_to,
                       1e-12,
                       1e-12));
  EXPECT_THROW(curve->at(curve->end() + 1.0), std::out_of_range);
  Problem open = problem;
  open.closures.clear();
  EXPECT_EQ(method->declines(open), "no closure to go half way to");
}

TEST(LoadPlugin, ExceptionsCrossTheFence) {
  const std::vector<MethodEntry> entries = load_plugin(kOutside / "half_way.so");
  EXPECT_THROW(entries[0].make({{"shere", 1.0}}), OptionError);
  const Stage stage = entries[2].make({});
  Report report;
  try {
    std::get<std::unique_ptr<const Method>>(stage)->estimate(test::circle(), report);
    FAIL() << "did not throw";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "thrown inside the plugin");
  }
}

TEST(LoadPlugin, MayBeLoadedTwice) {
  EXPECT_EQ(load_plugin(kOutside / "half_way.so").size(),
            load_plugin(kOutside / "half_way.so").size());
}

TEST(LoadPlugin, RefusesAnotherAbi) {
  expect_refused(kOutside / "misaligned.so", "was built with another");
}

TEST(LoadPlugin, ReadsTheInterfaceNumberBeforeAllElse) {
  expect_refused(kOutside / "outdated.so", "was built for plugin interface 1, this program has 2");
}

TEST(LoadPlugin, RefusesAnObjectWithoutThePluginLine) {
  expect_refused(kOutside / "silent.so", "has no LOOPBENCH_PLUGIN line");
}

TEST(LoadPlugin, RefusesAMissingFileByName) {
  expect_refused(kOutside / "nowhere.so", "No such file");
}

TEST(LoadPlugin, RefusesAFileThatIsNoSharedObject) {
  const auto path = kOutside / "no_object.so";
  std::ofstream(path) << "not a shared object\n";
  expect_refused(path, "no_object.so: ");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace loopbench
