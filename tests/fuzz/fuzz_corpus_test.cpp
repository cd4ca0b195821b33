/// Replays earlier findings of the fuzzer: tests/data/fuzz/<target>/<finding>.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/fuzz/targets.hpp"

namespace loopbench::fuzz_corpus_test {
namespace {

namespace fs = std::filesystem;

const fs::path kData = LOOPBENCH_TEST_DATA;

const std::map<std::string, void (*)(const fs::path&)> kTargets{{"tum", fuzz_tum},
                                                                {"kitti", fuzz_kitti},
                                                                {"euroc", fuzz_euroc},
                                                                {"any", fuzz_any},
                                                                {"g2o", fuzz_g2o},
                                                                {"times", fuzz_times},
                                                                {"closures", fuzz_closures},
                                                                {"bag", fuzz_bag},
                                                                {"csv", fuzz_csv},
                                                                {"config", fuzz_config}};

TEST(FuzzCorpus, IsReadOrRefusedByItsReader) {
  for (const auto& folder : fs::directory_iterator(kData / "fuzz")) {
    const auto read = kTargets.at(folder.path().filename().string());
    for (const auto& found : fs::directory_iterator(folder)) {
      EXPECT_NO_THROW(read(found.path())) << found.path();
    }
  }
}

TEST(FuzzCorpus, EveryReaderKeepsItsPromisesOnEverySample) {
  for (const char* const folder : {"good", "bad"}) {
    for (const auto& file : fs::directory_iterator(kData / folder)) {
      for (const auto& [name, read] : kTargets) {
        EXPECT_NO_THROW(read(file.path())) << name << " on " << file.path();
      }
    }
  }
}

}  // namespace
}  // namespace loopbench::fuzz_corpus_test
