#include "datasets/core/renamed.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "datasets/core/fields.hpp"

namespace loopbench::renamed_test {
namespace {

enum class Overlap { all, open };
auto choices(Overlap) {
  return std::array{std::pair{"all", Overlap::all}, std::pair{"open", Overlap::open}};
}

struct Options {
  double sigma_t = 0.0;
  Overlap overlap = Overlap::all;
  double share = 0.5;
};

template <class Visit>
void fields(Options& o, Visit visit) {
  visit("white_noise.sigma_t", o.sigma_t, "standard deviation [m]");
  visit("overlap", o.overlap, "steps that a loop changes");
  visit("share", o.share, "share of the gap [-]");
}

std::string why(const Params& given) {
  try {
    with(Options{}, given);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "";
}

TEST(Renamed, AnOldOptionIsRejectedWithTheNewName) {
  EXPECT_EQ(why({{"shake.sigma_t", 0.1}}), "shake.sigma_t: was renamed to 'white_noise.sigma_t'");
}

TEST(Renamed, AnOldOptionOfAnotherOwnerIsUnknown) {
  EXPECT_EQ(why({{"loss", 0.1}}),
            "loss: unknown option (has: white_noise.sigma_t, overlap, share)");
}

TEST(Renamed, AnOldValueIsRejectedWithTheNewOne) {
  EXPECT_EQ(why({{"overlap", std::string("whole")}}), "overlap = whole: was renamed to 'all'");
  EXPECT_EQ(why({{"overlap", std::string("half")}}), "overlap = half: expected one of all | open");
  EXPECT_EQ(why({{"overlap", std::string("all")}}), "");
}

TEST(Renamed, TheNewNameSeedsAsTheFirst) {
  EXPECT_EQ(first_name("simulated", "white_noise.sigma_t"), "shake.sigma_t");
  EXPECT_EQ(first_name("trajectory", "white_noise.sigma_t"), "white_noise.sigma_t");
  EXPECT_EQ(first_name("simulated", "seed"), "seed");
}

TEST(Renamed, NoNameIsBothOldAndNew) {
  std::set<std::pair<std::string_view, std::string_view>> before;
  for (const RenamedName& name : kRenamedNames) {
    EXPECT_TRUE(before.emplace(name.owner, name.before).second) << name.before;
  }
  for (const RenamedName& name : kRenamedNames) {
    EXPECT_FALSE(before.contains({name.owner, name.now})) << name.now;
  }
}

}  // namespace
}  // namespace loopbench::renamed_test
