/// The report in a browser: phone, laptop and large screen, light, dark and printed.
#include <gtest/gtest.h>

#include "tests/support/browser.hpp"

namespace loopbench::test::report_screens_test {
namespace {

class ReportScreens : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_chromium()) GTEST_SKIP() << "needs chromium";
    folder_.file("c.yaml",
                 "datasets: [{dataset: simulated, label: a, keyframes: 40}, {dataset: simulated, "
                 "label: b, keyframes: 40, path: office}]\n"
                 "methods:\n  - raw\n  - uniform\n"
                 "  - {method: dm, label: one, sweep: {turn_max: [0.1, 0.5, 2]}}\n"
                 "  - {method: dm, label: two, sweep: {turn_max: [0.1, 1], speed_band: [0.1, 1]}}\n"
                 "metrics: [ate, axis_error, rpe]\nrepeats: 2\n");
    ASSERT_EQ(loopbench_command("run c.yaml", folder_).exit_code, 0);
    ASSERT_EQ(loopbench_command("report results/c -o page.html", folder_).exit_code, 0);
    folder_.file("page.html", with_probe(read_all(folder_.path() / "page.html"), "fits.js"));
    // Chromium has no window narrower than 500 pixels, but frames.
    folder_.file("phone.html",
                 "<title></title><iframe src='page.html' width='390' height='844' "
                 "style='border: 0'></iframe><script>onmessage = (event) => { document.title = "
                 "event.data; };</script>");
  }
  /// The title of the page after the probe.
  std::string title(const std::string& options, const std::string& page = "page.html") {
    return title_of(in_browser(folder_, page, options));
  }
  TemporaryFolder folder_;
};

TEST_F(ReportScreens, FitAndPrint) {
  EXPECT_EQ(title("--virtual-time-budget=5000 --dump-dom", "phone.html"), "390 light a: well");
  EXPECT_EQ(title("--window-size=1280,800 --blink-settings=preferredColorScheme=0 --dump-dom",
                  "page.html#sequence=b"),
            "1280 dark b: well");
  EXPECT_EQ(title("--window-size=1920,1080 --dump-dom", "page.html?sequence=b"),
            "1920 light b: well");
  title("--print-to-pdf=\"$PWD/page.pdf\"");
  EXPECT_EQ(read_all(folder_.path() / "page.pdf").compare(0, 5, "%PDF-"), 0);
}

TEST_F(ReportScreens, EveryScoreOfTwoEstimatesIsInTheWindow) {
  const std::string golden = LOOPBENCH_TEST_DATA "/golden/";
  const std::string eval = "eval " + golden + "gt.txt " + golden + "est_drift.txt " + golden +
                           "est_corrected.txt --report page.html";
  ASSERT_EQ(loopbench_command(eval, folder_).exit_code, 0);
  folder_.file("page.html", with_probe(read_all(folder_.path() / "page.html"), "cells.js"));
  const std::string dump = "--virtual-time-budget=5000 --dump-dom";
  EXPECT_EQ(title(dump, "phone.html"), "390 of true: well");
  EXPECT_EQ(title("--window-size=1280,800 " + dump), "1280 of true: well");
  EXPECT_EQ(title("--window-size=1920,1080 " + dump), "1920 of true: well");
}

}  // namespace
}  // namespace loopbench::test::report_screens_test
