/// Replays earlier findings of the fuzzer: tests/data/fuzz/<target>/<finding>.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/fuzz/targets.hpp"

namespace loopbench::fuzz_corpus_test {
namespace {

namespace fs = std::filesystem;

const fs::path kData = LOOPBENCH_TEST_DATA;

/// Readers of binary files; all others are called with every sample of any format.
const std::set<std::string> kBinary{"image", "messages", "report", "store"};

TEST(FuzzCorpus, IsReadOrRefusedByItsReader) {
  for (const auto& folder : fs::directory_iterator(kData / "fuzz")) {
    const auto read = fuzz_targets().at(folder.path().filename().string());
    for (const auto& found : fs::directory_iterator(folder)) {
      EXPECT_NO_THROW(read(found.path())) << found.path();
    }
  }
}

TEST(FuzzCorpus, ReportReadsOrRejectsEveryStore) {
  for (const auto& found : fs::directory_iterator(kData / "fuzz" / "store")) {
    EXPECT_NO_THROW(fuzz_store(found.path())) << found.path();
    EXPECT_NO_THROW(fuzz_report(found.path())) << found.path();
  }
}

TEST(FuzzCorpus, EveryReaderKeepsItsPromisesOnEverySample) {
  for (const char* const folder : {"good", "bad"}) {
    for (const auto& file : fs::directory_iterator(kData / folder)) {
      for (const auto& [name, read] : fuzz_targets()) {
        if (kBinary.contains(name)) continue;
        EXPECT_NO_THROW(read(file.path())) << name << " on " << file.path();
      }
    }
  }
}

}  // namespace
}  // namespace loopbench::fuzz_corpus_test
