/// Chains of the same odometer in a sweep: what methods get of them, and what depends on them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/run/cell_keys.hpp"
#include "harness/run/pack.hpp"
#include "harness/run/summarise_sequence.hpp"
#include "tests/support/temporary_folder.hpp"

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
  const std::string bytes = packed(sent);
  Unpacker unpacker(bytes);
  Sequence received;
  unpacker(received);
  ASSERT_NE(received.problem.related, nullptr);
  EXPECT_EQ(received.problem.related->front().odometry.size(),
            sent.problem.related->front().odometry.size());
}

TEST_F(Odometer, TheSameFileWithOtherOptionsIsNoOtherChain) {
  const TemporaryFolder folder;
  std::ofstream poses(folder.path() / "walk.txt");
  for (int i = 0; i < 40; ++i) poses << i << " " << i << " " << i * i << " 0 0 0 0 1\n";
  poses.close();
  const Sweep sweep = parse_sweep(R"(
datasets:
  - {dataset: trajectory, estimate: walk.txt, odometer: feet, keyframes: {rule: every}, sweep: {keyframes.value: [2, 3]}}
methods: [raw]
metrics: [path_length]
)",
                                  (folder.path() / "c.yaml").string(),
                                  known_);
  EXPECT_EQ(load_sequence({}, sweep, known_, {{folder.path()}}).problem.related, nullptr);
}

TEST_F(Odometer, ClosuresOfOtherChainsThatEqualTheReferenceAreOracleClosures) {
  const TemporaryFolder folder;
  const auto walk = [](double scale) {
    std::string out;
    for (int i = 0; i < 40; ++i) {
      const char* rotation = i == 0 ? "0 0 0.6 0.8" : "0 0 0 1";
      out += fmt::format("{} {} {} 0 {}\n", i, scale * i, 0.01 * i * i, rotation);
    }
    return out;
  };
  for (const std::string name : {"a.txt", "b.txt"}) folder.file(name, walk(1.01));
  folder.file("truth.txt", walk(1.0));
  folder.file("exact.txt", "1 19 18 3.6 0 0 0 0 1\n");
  const Sweep sweep = parse_sweep(R"(
datasets:
  - {dataset: trajectory, label: a, estimate: a.txt, odometer: feet}
  - {dataset: trajectory, label: b, estimate: b.txt, reference: truth.txt, closures: {source: file, file: exact.txt}, odometer: feet}
methods: [raw]
metrics: [path_length]
)",
                                  "c.yaml",
                                  known_);
  EXPECT_TRUE(load_sequence({}, sweep, known_, {{folder.path()}}).provenance.oracle_closures);
}

TEST_F(Odometer, FilesOfOtherChainsAreFoundInANewDataFolder) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, double step) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    std::ofstream poses(folder.path() / name);
    for (int i = 0; i < 40; ++i) poses << i << " " << i * step << " 0 0 0 0 0 1\n";
  };
  for (const std::string name : {"a.txt", "b.txt"}) {
    write("old/" + name, 1.0);
    write("new/" + name, name == "b.txt" ? 2.0 : 1.0);
  }
  const Sweep sweep = parse_sweep(R"(
datasets:
  - {dataset: trajectory, label: a, estimate: a.txt, odometer: feet}
  - {dataset: trajectory, label: b, estimate: b.txt, odometer: feet}
methods: [raw]
metrics: [path_length]
)",
                                  "c.yaml",
                                  known_);
  const DataRoot old{{folder.path() / "old"}}, fresh{{folder.path() / "new"}};
  const auto stored = hashed_inputs(load_sequence({}, sweep, known_, old).provenance.inputs);
  const auto now = CellKeys(sweep, known_, fresh, "build").current_inputs({}, stored);
  ASSERT_EQ(now.size(), 2u);
  EXPECT_EQ(now[0].hash, stored[0].hash);
  EXPECT_NE(now[1].hash, stored[1].hash);
}

TEST_F(Odometer, ANameThatOneDatasetHasIsAnError) {
  EXPECT_THAT(
      [&] {
        parse_sweep("datasets: [{dataset: simulated, odometer: whels}]\nmethods: [raw]\n",
                    "c.yaml",
                    known_);
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr("has the odometer 'whels'")));
}

TEST_F(Odometer, ProgramsCannotHaveIt) {
  EXPECT_THAT(
      [&] {
        parse_sweep(
            "datasets: [{dataset: command, run: 'x {trajectory}', odometer: o}, {dataset: "
            "simulated, odometer: "
            "o}]\n",
            "c.yaml",
            known_);
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr("expected a built-in dataset")));
}

}  // namespace
}  // namespace loopbench::odometer_test
