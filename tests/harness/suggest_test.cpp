#include "harness/sweep/text/suggest.hpp"

#include <gtest/gtest.h>

#include "metrics/protocols/protocol.hpp"

namespace loopbench::suggest_test {

using namespace harness;
using metrics::Protocol;
using Text = std::string;

namespace {

const std::vector<std::string> kKnown{"uniform", "polyline", "cubic_spline", "dm_n4"};

TEST(Suggest, FindsASlipOfTheHand) {
  EXPECT_EQ(closest("unifrom", kKnown), "uniform");   // swapped
  EXPECT_EQ(closest("polylne", kKnown), "polyline");  // missing letter
  EXPECT_EQ(closest("dm_n5", kKnown), "dm_n4");
}

TEST(Suggest, LooksAtNothingThatIsFarTooLong) {
  EXPECT_EQ(closest("uniformly__", kKnown), "");
  EXPECT_EQ(closest(std::string(1'000'000, 'u'), kKnown), "");
}

TEST(Suggest, DoesNotGuessWildly) {
  EXPECT_EQ(closest("spaghetti", kKnown), "");
  EXPECT_EQ(closest("ref", {"set"}), "");
  EXPECT_EQ(unknown_name("method", "spaghetti", kKnown),
            "no method is named 'spaghetti' (known: uniform, polyline, cubic_spline, dm_n4)");
  EXPECT_EQ(unknown_name("method", "unifrom", kKnown),
            "no method is named 'unifrom'; did you mean 'uniform'?");
}

TEST(Suggest, NamesTheClosestOptionOrWordThatWasExpected) {
  const auto guessed = [](const Params& given, const std::vector<std::string>& further = {}) {
    try {
      with(Protocol{}, given);
    } catch (const OptionError& error) {
      return with_guess(error, further);
    }
    return std::string();
  };
  EXPECT_EQ(guessed({{"algin", Text("se3")}}).substr(0, 49),
            "algin: unknown option; did you mean 'align'? (has");
  EXPECT_EQ(guessed({{"lable", Text("a")}}, {"label"}).substr(0, 49),
            "lable: unknown option; did you mean 'label'? (has");
  EXPECT_EQ(guessed({{"align", Text("simm3")}}, {"simm"}),
            "align = simm3: expected one of se3 | sim3 | scale | posyaw | origin | posyaw_origin | "
            "none; did you mean "
            "'sim3'?");
  EXPECT_EQ(
      guessed({{"align", std::int64_t{7}}}),
      "align = 7: expected one of se3 | sim3 | scale | posyaw | origin | posyaw_origin | none");
  EXPECT_EQ(guessed({{"max_diff", -1.0}}), "max_diff = -1.0: expected 0 <= max_diff");
}

}  // namespace
}  // namespace loopbench::suggest_test
