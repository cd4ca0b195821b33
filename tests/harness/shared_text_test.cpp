/// Texts that are kept once, and numbers of the texts of records.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "harness/model/text_index.hpp"
#include "tests/support/refusal_of.hpp"

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

TEST(TextIndex, NumbersTextsInOrderOfAppearance) {
  std::mt19937 bits(1);
  const auto label = [&](const char* stem) { return stem + std::to_string(bits() % 3); };
  const auto text = [](const Record& r) {
    return metric_label(r) + "/" + std::to_string(r.repeat % 2) + (r.oracle ? "!" : "");
  };
  TextIndex index({"label", "repeat", "oracle"}, text);
  std::map<std::string, std::size_t> expected;
  for (int i = 0; i < 2000; ++i) {
    Record r;
    r.sequence = label("s");
    r.metric = label("m");
    if (bits() % 2 == 0) r.label = label("l");
    r.repeat = static_cast<std::int64_t>(bits() % 4);
    r.oracle = bits() % 2 == 0;
    const std::size_t number = expected.emplace(text(r), expected.size()).first->second;
    ASSERT_EQ(index.index(r), number);
    ASSERT_EQ(index.texts()[number], text(r));
  }
  EXPECT_EQ(index.texts().size(), 24u);  // 6 labels, odd or even, oracle or not
}

TEST(TextIndex, RejectsUnknownFields) {
  EXPECT_EQ(refusal_of([] { TextIndex({"sequense"}, [](const Record&) { return ""; }); }),
            refusal_of([] { field(Record{}, "sequense"); }));
}

}  // namespace
}  // namespace loopbench::shared_text_test
