#include "datasets/core/fields.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace loopbench::fields_test {
namespace {

enum class RotationMode { none, slerp };
inline auto choices(RotationMode) {
  return std::array{std::pair{"none", RotationMode::none}, std::pair{"slerp", RotationMode::slerp}};
}

struct Options {
  double share = 0.5;
  int count = 3;
  bool robust = true;
  std::string label = "a";
  RotationMode rotation = RotationMode::slerp;
  std::optional<double> band;
};

template <class Visit>
void fields(Options& o, Visit visit) {
  visit("share", o.share, "part of the gap [-]", Between{0.0, 1.0});
  visit("count", o.count, "how many", Between{1});
  visit("robust", o.robust, "or not");
  visit("label", o.label, "a word");
  visit("rotation", o.rotation, "interpolation of the rotation");
  visit("band", o.band, "speed band [m/s]", GreaterThan{0.0});
}

std::string why(const Params& given) {
  try {
    with(Options{}, given);
  } catch (const OptionError& error) {
    EXPECT_EQ(error.option(), given.begin()->first);
    return error.what();
  }
  return "";
}

TEST(Fields, TellTextFromAnOptionalNumber) {
  Options defaults;
  defaults.label = "none";
  defaults.rotation = RotationMode::none;
  std::string text, optional;
  for (const OptionInfo& option : describe(defaults)) {
    if (option.is_text) text += option.name + " ";
    if (option.is_optional) optional += option.name + " ";
  }
  EXPECT_EQ(text, "label rotation ");  // and not band, whose default is the word none too
  EXPECT_EQ(optional, "band ");
}

TEST(Fields, EchoNamesEveryFieldWithItsDefault) {
  EXPECT_EQ(to_text(echo(Options{})),
            "band=none, count=3, label=a, robust=true, rotation=slerp, share=0.5");
}

TEST(Fields, DescribeKeepsTheDeclaredOrderAndTheRules) {
  const std::vector<OptionInfo> options = describe(Options{});
  ASSERT_EQ(options.size(), 6u);
  EXPECT_EQ(options[0].rule, "0 <= share <= 1");
  EXPECT_EQ(options[1].rule, "1 <= count");
  EXPECT_EQ(options[4].rule, "none | slerp");
  EXPECT_EQ(options[5].rule, "band > 0");
  EXPECT_EQ(options[0].help, "part of the gap [-]");
  EXPECT_EQ(options[0].range.high, 1.0);
  EXPECT_TRUE(std::isinf(options[1].range.high));
  EXPECT_EQ(options[4].words, (std::vector<std::string>{"none", "slerp"}));
  EXPECT_EQ(options[5].range.low, 0.0);
  EXPECT_TRUE(options[5].range.is_open);
}

TEST(Fields, WithReplacesOnlyWhatIsGiven) {
  const Options got = with(Options{},
                           {{"share", std::int64_t{1}},
                            {"rotation", std::string("none")},
                            {"band", 0.33},
                            {"count", std::int64_t{7}}});
  EXPECT_EQ(got.share, 1.0);
  EXPECT_EQ(got.rotation, RotationMode::none);
  EXPECT_EQ(got.band, 0.33);
  EXPECT_EQ(got.count, 7);
  EXPECT_EQ(got.label, "a");
}

TEST(Fields, EchoOfWithReadsBack) {
  const Params changed{{"share", 0.25}, {"band", 2.5}, {"robust", false}};
  const Params echoed = echo(with(Options{}, changed));
  EXPECT_EQ(echo(with(Options{}, echoed)), echoed);
}

TEST(Fields, RefusesByNameAndRule) {
  EXPECT_EQ(why({{"shere", 1.0}}),
            "shere: unknown option (has: share, count, robust, label, rotation, band)");
  EXPECT_EQ(why({{"share", 1.4}}), "share = 1.4: expected 0 <= share <= 1");
  EXPECT_EQ(why({{"share", std::nan("")}}), "share = nan: expected a number");
  EXPECT_EQ(why({{"count", 1.5}}), "count = 1.5: expected a whole number");
  EXPECT_EQ(why({{"count", std::int64_t{1} << 40}}),
            "count = 1099511627776: expected a whole number");
  EXPECT_EQ(why({{"robust", std::int64_t{1}}}), "robust = 1: expected true or false");
  EXPECT_EQ(why({{"rotation", std::string("spin")}}),
            "rotation = spin: expected one of none | slerp");
  EXPECT_EQ(why({{"band", -0.5}}), "band = -0.5: expected band > 0");
}

TEST(Params, TextOfADoubleReadsBack) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, -2.5e17, 6.02214076e23, 5e-324}) {
    EXPECT_EQ(std::strtod(to_text(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(to_text(1.0), "1.0");
  EXPECT_EQ(to_text(0.1), "0.1");
}

}  // namespace
}  // namespace loopbench::fields_test
