/// The calibration plot of the report.
#include <fmt/format.h>

#include "tests/support/browser.hpp"

namespace loopbench::report_covariances_test {
namespace {

using namespace test;

/// A path with errors of 0.01 m; the stated deviations [m] follow each pose if they are positive.
std::string path(double error, double stated) {
  std::string out;
  for (int i = 0; i < 60; ++i) {
    const double sign = i % 2 == 0 ? error : -error;
    out += fmt::format("{} {} {} {} 0 0 0 1", i, 0.1 * i + sign, std::sin(0.1 * i) + sign, sign);
    for (int k = 0; stated > 0.0 && k < 36; ++k) {
      out += fmt::format(" {}", k % 7 != 0 ? 0.0 : k < 21 ? stated * stated : 1e-4);
    }
    out += "\n";
  }
  return out;
}

TEST(ReportOfCovariances, DrawsTheirCoverage) {
  if (!has_chromium()) GTEST_SKIP() << "needs chromium";
  const TemporaryFolder folder;
  folder.file("gt.txt", path(0.0, 0.0));
  folder.file("wide.txt", path(0.01, 0.03));
  folder.file("narrow.txt", path(0.01, 0.003));
  const CommandResult made = loopbench_command(
      "eval gt.txt wide.txt narrow.txt --metric ate --metric nees --report page.html", folder);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string dom = in_browser(folder, "page.html", "--dump-dom");
  EXPECT_NE(dom.find("wide: 100 % inside the 95 % region"), std::string::npos);
  EXPECT_NE(dom.find("narrow: 0 % inside the 50 % region"), std::string::npos);
  ASSERT_EQ(loopbench_command("eval gt.txt wide.txt --report plain.html", folder).exit_code, 0);
  const std::string plain = in_browser(folder, "plain.html", "--dump-dom");
  EXPECT_NE(plain.find("<section id=\"calibration\" class=\"drawn\" hidden"), std::string::npos);
}

}  // namespace
}  // namespace loopbench::report_covariances_test
