// Building blocks of the report page: escaped text, packed numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/report/html.hpp"
#include "harness/report/packed.hpp"

namespace loopbench {
namespace {

TEST(Html, EscapesWhatMarkupIsMadeOf) {
  EXPECT_EQ(html_text("<b a=\"1\" c='2'>&\x01"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(html_text("drehung °"), "drehung °");
}

TEST(Html, NothingInAScriptEndsIt) {
  const std::string text = script_text(nlohmann::json("</script><!--").dump());
  EXPECT_EQ(text, "\"\\u003c/script>\\u003c!--\"");
  EXPECT_EQ(nlohmann::json::parse(text), "</script><!--");
}

TEST(Html, TablesEscapeAndMark) {
  const Sheet sheet{"a<b", {"method", "x"}, {{{"m&m"}, {"1.0", Mark::best}}}, {"note <i>"}};
  const std::string html = html_table(sheet);
  EXPECT_NE(html.find("<caption>a&lt;b</caption>"), std::string::npos);
  EXPECT_NE(html.find("<th scope=\"row\">m&amp;m</th><td class=\"best\">1.0</td>"),
            std::string::npos);
  EXPECT_NE(html.find("<li>note &lt;i&gt;</li>"), std::string::npos);
}

TEST(Packed, IsSixteenBitsOfTheRange) {
  // 0, half of 65534 and 65534 as little-endian words; then NaN.
  const auto json = nlohmann::json::parse(packed({-1.0, 0.0, 1.0, std::nan("")}));
  EXPECT_EQ(json["lo"], -1.0);
  EXPECT_NEAR(json["step"].get<double>(), 2.0 / 65534.0, 1e-11);
  EXPECT_EQ(json["b"], "AAD/f/7///8=");
  EXPECT_EQ(nlohmann::json::parse(packed({}))["b"], "");
  EXPECT_EQ(nlohmann::json::parse(packed({5.0, 5.0}))["b"], "AAAAAA==");
}

TEST(Packed, ThinsWithBothEndsKept) {
  EXPECT_EQ(thinned_places(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(thinned_places(101, 3), (std::vector<std::size_t>{0, 50, 100}));
  EXPECT_EQ(thinned_places(9, 1), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(thinned_places(0, 5).empty());
}

}  // namespace
}  // namespace loopbench
