#include "datasets/derive/false_closures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/dataset.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::false_closures_test {
namespace {

using testing::HasSubstr;

Problem chain(std::size_t keyframes, std::size_t closures) {
  Problem out;
  out.keyframes = random_walk(keyframes, 3, 1.0, 0.1);
  for (std::size_t k = 0; k < closures; ++k) {
    out.closures.push_back({0, keyframes - 1, {}, Matrix6::Identity()});
  }
  return out;
}

TEST(FalseClosures, ShortChainsGetTheirShareToo) {
  for (const std::size_t keyframes : {3u, 4u, 10u, 39u, 40u, 200u}) {
    Problem problem = chain(keyframes, 6);
    EXPECT_EQ(add_false_closures(problem, {0.5, 1}, 0), 6u) << keyframes;
    EXPECT_EQ(problem.closures.size(), 12u);
    for (const Edge& closure : problem.closures) {
      EXPECT_GE(closure.to - closure.from, std::max<std::size_t>(2, keyframes / 20));
    }
  }
  Problem two = chain(2, 1);
  EXPECT_THAT(refusal_of([&] {
                add_false_closures(two, {0.5, 1}, 0);
              }),
              HasSubstr("found 2 keyframes, expected at least 3"));
  EXPECT_EQ(add_false_closures(two, {0.0, 1}, 0), 0u);
}

TEST(FalseClosures, IdentitiesDrawIndependently) {
  Problem a = chain(200, 20), b = a, c = a;
  add_false_closures(a, {0.5, 1}, 1);
  add_false_closures(b, {0.5, 1}, 1);
  add_false_closures(c, {0.5, 1}, 2);
  const auto ends = [](const Problem& problem) {
    std::vector<std::size_t> out;
    for (const Edge& edge : problem.closures) out.push_back(edge.from);
    return out;
  };
  EXPECT_EQ(ends(a), ends(b));
  EXPECT_NE(ends(a), ends(c));
}

TEST(FalseClosures, ProvenanceCountsWhatWasAdded) {
  const TemporaryFolder folder;
  std::string poses;
  for (int i = 0; i <= 12; ++i) {
    poses += std::to_string(i) + " " + std::to_string(i % 6) + " 0 0 0 0 0 1\n";
  }
  folder.file("est.txt", poses);
  folder.file("loops.txt", "0 12 0 0 0 0 0 0 1\n1 7 0 0 0 0 0 0 1\n2 8 0 0 0 0 0 0 1\n");
  const auto closures = [&](double share) {
    return load_dataset("trajectory",
                        {{"estimate", "est.txt"},
                         {"closures.source", "file"},
                         {"closures.file", "loops.txt"},
                         {"false_closures.share", share}},
                        {{folder.path()}})
        .provenance.closures;
  };
  EXPECT_EQ(closures(0.0), "file: loops.txt (3)");
  EXPECT_EQ(closures(0.5), "file: loops.txt (6), 3 of 6 false and added");
  EXPECT_EQ(closures(0.1),
            "file: loops.txt (3), 0 of 3 false and added");  // 1/3 closure, rounded to 0
}

}  // namespace
}  // namespace loopbench::false_closures_test
