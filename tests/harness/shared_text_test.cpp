/// Texts that are kept once.
#include "harness/sweep/model/shared_text.hpp"

#include <gtest/gtest.h>

namespace loopbench::shared_text_test {

using namespace harness;

namespace {

TEST(SharedText, IsTheSameForEqualTexts) {
  const SharedText a = "room";
  const SharedText b = std::string("ro") + "om";
  EXPECT_EQ(a, b);
  EXPECT_EQ(a.id(), b.id());
  EXPECT_NE(a, SharedText("office"));
  EXPECT_TRUE(a == "room" && a == std::string("room") && a != "");
  EXPECT_EQ(SharedText(), SharedText(""));
  EXPECT_TRUE(SharedText("").empty());
  SharedText c = a;
  c.clear();
  EXPECT_EQ(c, "");
  EXPECT_EQ(a.text(), "room");
  EXPECT_LT(SharedText("a"), SharedText("b"));
  EXPECT_EQ("<" + a + ">", "<room>");
}

}  // namespace
}  // namespace loopbench::shared_text_test
