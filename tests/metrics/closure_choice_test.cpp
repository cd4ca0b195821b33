// Shares of false closures that were kept and of true ones that were rejected, counted by hand.
#include "metrics/correction/closure_choice.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::closure_choice_test {

using namespace metrics;
using testing::HasSubstr;

namespace {

using Indices = std::vector<std::size_t>;

/// Five closures of a circle, of which some are false and some were rejected.
class Choice {
 public:
  Choice(std::optional<Indices> false_ones, std::optional<Indices> rejected)
      : false_ones_(std::move(false_ones)), rejected_(std::move(rejected)) {
    problem_.closures.resize(5, {0, 1, {}});
    evaluation_.context.problem = &problem_;
    if (false_ones_) evaluation_.context.false_closures = &*false_ones_;
    if (rejected_) evaluation_.context.rejected_closures = &*rejected_;
  }
  Choice(const Choice&) = delete;

  double kept_false() const { return closures_kept_false(evaluation_, {}).at(0).statistics.mean; }
  double dropped_true() const {
    return closures_dropped_true(evaluation_, {}).at(0).statistics.mean;
  }

 private:
  Problem problem_;
  std::optional<Indices> false_ones_, rejected_;
  Evaluation evaluation_;
};

TEST(ClosureChoice, CountsBothMistakes) {
  const Choice choice(Indices{1, 4}, Indices{0, 1});  // keeps the false 4, drops the true 0
  EXPECT_DOUBLE_EQ(choice.kept_false(), 50.0);
  EXPECT_DOUBLE_EQ(choice.dropped_true(), 100.0 / 3.0);
}

TEST(ClosureChoice, IsZeroIfRightAndHundredIfAllIsWrong) {
  EXPECT_EQ(Choice(Indices{1, 4}, Indices{1, 4}).kept_false(), 0.0);
  EXPECT_EQ(Choice(Indices{1, 4}, Indices{1, 4}).dropped_true(), 0.0);
  EXPECT_EQ(Choice(Indices{1, 4}, Indices{0, 2, 3}).kept_false(), 100.0);
  EXPECT_EQ(Choice(Indices{1, 4}, Indices{0, 2, 3}).dropped_true(), 100.0);
  EXPECT_EQ(Choice(Indices{}, Indices{}).dropped_true(), 0.0);
}

TEST(ClosureChoice, IsUndefinedRatherThanZero) {
  const auto reason = [](const Choice& choice) {
    return refusal_of<Undefined>([&] { choice.kept_false(); });
  };
  EXPECT_THAT(reason({std::nullopt, Indices{1}}),
              HasSubstr("which closures are false is not known"));
  EXPECT_THAT(reason({Indices{1}, std::nullopt}),
              HasSubstr("the method does not state which closures it rejects"));
  EXPECT_THAT(reason({Indices{}, Indices{}}), HasSubstr("no closure is false"));
  const Choice all(Indices{0, 1, 2, 3, 4}, Indices{});
  EXPECT_THAT(refusal_of<Undefined>([&] { all.dropped_true(); }), HasSubstr("no closure is true"));
  EXPECT_THROW(closures_kept_false(Evaluation{}, {}), Undefined);  // two files
}

}  // namespace
}  // namespace loopbench::closure_choice_test
