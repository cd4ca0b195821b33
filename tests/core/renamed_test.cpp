#include "datasets/core/renamed.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "datasets/core/fields.hpp"

namespace loopbench::renamed_test {
namespace {

struct Options {
  double sigma_t = 0.0;
  double share = 0.5;
};

template <class Visit>
void fields(Options& o, Visit visit) {
  visit("white_noise.sigma_t", o.sigma_t, "standard deviation [m]");
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
  EXPECT_EQ(why({{"loss", 0.1}}), "loss: unknown option (has: white_noise.sigma_t, share)");
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
