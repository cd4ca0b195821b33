/// Chains of the same odometer in a sweep: what methods get of them, and what depends on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/run/cell_keys.hpp"
#include "harness/run/pack.hpp"

namespace loopbench::odometer_test {

using namespace harness;

namespace {

std::string config(const std::string& length) {
  return R"(
datasets:
  - {dataset: simulated, label: a, odometer: wheels, keyframes: 40}
  - {dataset: simulated, label: b, keyframes: 50}
  - {dataset: simulated, label: c, odometer: wheels, keyframes: )" +
         length + R"(}
methods: [raw]
metrics: [ate]
)";
}

class Odometer : public testing::Test {
 protected:
  Sequence load(std::size_t dataset) const {
    return load_sequence({.dataset = dataset}, sweep_, known_, {});
  }
  std::string hash(const Sweep& sweep, std::size_t dataset) const {
    CellKeys keys(sweep, known_, {}, "build");
    return keys.configuration_hash({.dataset = dataset});
  }

  Catalogue known_ = catalogue({});
  Sweep sweep_ = parse_sweep(config("60"), "c.yaml", known_);
};

TEST_F(Odometer, MethodsGetItsOtherChainsWithoutFrames) {
  const Problem a = load(0).problem;
  ASSERT_NE(a.related, nullptr);
  ASSERT_EQ(a.related->size(), 1u);
  const Problem& c = a.related->front();
  EXPECT_EQ(c.keyframes.size(), 60u);
  EXPECT_EQ(c.closures.size(), load(2).problem.closures.size());
  EXPECT_TRUE(c.frames.empty());
  EXPECT_EQ(load(1).problem.related, nullptr);
}

TEST_F(Odometer, CellsDependOnItsOtherChains) {
  const Sweep longer = parse_sweep(config("70"), "c.yaml", known_);
  EXPECT_NE(hash(sweep_, 0), hash(longer, 0));
  EXPECT_EQ(hash(sweep_, 1), hash(longer, 1));
}

TEST_F(Odometer, ChainsReachTheProcessOfACell) {
  const Sequence sent = load(0);
  Unpacker unpacker(packed(sent));
  Sequence received;
  unpacker(received);
  ASSERT_NE(received.problem.related, nullptr);
  EXPECT_EQ(received.problem.related->front().odometry.size(),
            sent.problem.related->front().odometry.size());
}

}  // namespace
}  // namespace loopbench::odometer_test
