/// The page of a report may run its own scripts and styles only.
#include "harness/report/report.hpp"
#include "harness/report/sha256.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::report_policy_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using namespace tiny_store;  // NOLINT: the fixture

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ReportPolicy : public TinyStore {};

TEST(Sha256, AgreesWithPublishedValues) {  // FIPS 180-4 examples
  EXPECT_EQ(base64_sha256(""), "47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
  EXPECT_EQ(base64_sha256("abc"), "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
  EXPECT_EQ(base64_sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "JI1qYdIGOLjlwCaTDD5gOaM85Flk/yFn9uzt1BnbBsE=");
  EXPECT_EQ(base64_sha256(std::string(1'000'000, 'a')),
            "zcduXJkU+5KBocfihNc+Z/GAmkiklyAOBG05zMcRLNA=");
}

TEST_F(ReportPolicy, APolicyAllowsItsOwnScriptsAndStylesOnly) {
  run(kUsual);
  const std::string html = report_html(read_report_content(folder_.path()));
  const std::string meta = "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  const std::size_t begin = html.find(meta) + meta.size();
  const std::string policy = html.substr(begin, html.find('"', begin) - begin);
  EXPECT_TRUE(policy.starts_with("default-src 'none'; ")) << policy;
  EXPECT_FALSE(has(policy, "unsafe"));
  EXPECT_FALSE(has(policy, "http"));
  EXPECT_LT(begin, html.find("<title>")) << "it precedes everything it governs";
  std::size_t elements = 0;
  for (const std::string open : {"<script>", "<style>"}) {
    const std::string close = "</" + open.substr(1);
    for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at)) {
      at += open.size();
      const std::string text = html.substr(at, html.find(close, at) - at);
      EXPECT_TRUE(has(policy, "'sha256-" + base64_sha256(text) + "'")) << text.substr(0, 60);
      ++elements;
    }
  }
  EXPECT_EQ(elements, 16u);
  EXPECT_FALSE(has(html, " style=\""));
  EXPECT_FALSE(has(html, " onclick="));
}

}  // namespace
}  // namespace loopbench::report_policy_test
