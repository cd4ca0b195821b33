/// Provenance of exported tables.
#include "harness/answers/tables/store_provenance.hpp"

#include <gtest/gtest.h>

namespace loopbench::store_provenance_test {

using namespace harness;

namespace {

TEST(StoreProvenance, NamesNoFoldersOfTheMachine) {
  StoreProvenance provenance;
  provenance.run = {{"config", "estimate: /home/me/runs/a.txt, 'x/y/z'"}};
  provenance.inputs = {{"room", {{"reference", "/data/tum/room/gt.txt", 9, "f00d"}}}};
  EXPECT_EQ(provenance_lines(provenance, "% "),
            "% read for room: room/gt.txt 9 bytes f00d\n"
            "% config: estimate: runs/a.txt, 'x/y/z'\n");
}

}  // namespace
}  // namespace loopbench::store_provenance_test
