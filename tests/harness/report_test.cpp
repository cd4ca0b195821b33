/// Reports: contents, size, and rendering in a browser.
#include "harness/answers/report/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "harness/answers/report/curve.hpp"
#include "harness/answers/report/data.hpp"
#include "harness/answers/report/draw.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/store/store.hpp"
#include "tests/support/browser.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::tiny::report_test {
namespace {

/// A sweep with awkward names, a failure and a decline, computed once.
class OfASweep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const std::filesystem::path config =
        folder_->file("c.yaml",
                      "description: '</script><script>alert(1)</script>'\n"
                      "datasets:\n"
                      "  - {dataset: line, bias: 0.1, label: '</script><b>\"a\" & ''b'''}\n"
                      "  - {dataset: line, bias: 0.2, label: b}\n"
                      "methods:\n"
                      "  - straight\n"
                      "  - {method: shift, label: '<i>&'}\n"
                      "  - {method: shift, label: swept, sweep: {by: [1, 2]}}\n"
                      "  - {method: shift, label: broken, fail: true}\n"
                      "  - {method: shift, label: unwilling, decline: true}\n"
                      "metrics: [ate, {metric: ate, power: 2, label: undefined}]\n"
                      "baseline: straight\nrepeats: 3\n");
    const Catalogue catalogue = tiny::catalogue();
    const Sweep sweep = read_sweep(config, catalogue);
    const DataRoot root{{folder_->path()}};
    CellKeys keys(sweep, catalogue, root, "build");
    Store store(folder_->path() / "results.sqlite", keys, {{"commit", "<c0ffee>"}});
    const std::vector<Cell> all = cells(sweep, seeded(sweep, catalogue), "");
    store.resume(all, all, Retry::none);
    run_here(sweep, all, catalogue, root, [&](const CellResult& result) { store.write(result); });
    content_ = new ReportContent(read_report_content(folder_->path()));
    html_ = new std::string(report_html(*content_));
  }
  static void TearDownTestSuite() {
    delete html_;
    delete content_;
    delete folder_;
  }
  static nlohmann::json data() {
    const std::string open = "<script type=\"application/json\" id=\"report-data\">";
    const std::size_t begin = html_->find(open) + open.size();
    return nlohmann::json::parse(html_->substr(begin, html_->find("</script>", begin) - begin));
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline ReportContent* content_ = nullptr;
  static inline std::string* html_ = nullptr;
};

const char* const kAwkward = "</script><b>\"a\" & 'b'";

TEST_F(OfASweep, EscapesEveryName) {
  EXPECT_FALSE(has(*html_, kAwkward));
  EXPECT_FALSE(has(*html_, "<script>alert"));
  EXPECT_FALSE(has(*html_, "<i>&"));
  EXPECT_FALSE(has(*html_, "<c0ffee>"));
  EXPECT_TRUE(has(*html_, "&lt;c0ffee&gt;"));
  EXPECT_TRUE(has(*html_, "&lt;/script&gt;&lt;b&gt;&quot;a&quot; &amp; &#39;b&#39;"));
  EXPECT_EQ(data()["scores"]["sequences"][0], kAwkward);
  EXPECT_EQ(data()["scores"]["methods"][1], "<i>&");
}

TEST_F(OfASweep, HoldsScoresAndTracesOfEveryRepeat) {
  const nlohmann::json all = data();
  EXPECT_EQ(all["scores"]["cells"].size(), 36u);  // 2 sequences, 6 methods, 3 repeats
  EXPECT_EQ(all["scores"]["baseline"], "straight");
  EXPECT_EQ(all["traces"]["cells"].size(), 24u);  // 2 sequences, 4 methods that ran, 3 repeats
  EXPECT_EQ(all["traces"]["sequences"].size(), 2u);
  const nlohmann::json& cell = all["scores"]["cells"][0];
  const auto found = std::ranges::find_if(content_->records, [](const Record& r) {
    return r.cell->position == content_->cells[0].position && r.kind->metric == "ate";
  });
  ASSERT_NE(found, content_->records.end());
  EXPECT_NEAR(
      cell["values"][0][0].get<double>(), found->statistics.rmse, 1e-4 * found->statistics.rmse);
  EXPECT_LT(html_->size(), 500'000u);
  const nlohmann::json& cut = all["traces"]["cells"]["3"]["cut"];  // straight has none, <i>& has
  EXPECT_EQ(cut[0]["kind"], "window");
  EXPECT_EQ(cut[0]["names"][0], "shifted");
  EXPECT_FALSE(all["traces"]["cells"]["0"].contains("cut"));
}

TEST_F(OfASweep, ReadsSweptOptionsFromTheConfig) {
  const nlohmann::json scores = data()["scores"];
  const nlohmann::json of_sequences = scores["sequence_families"].at(0);
  EXPECT_EQ(of_sequences["options"], nlohmann::json({"bias"}));
  EXPECT_EQ(of_sequences["members"], nlohmann::json::parse("[[0, 0.1], [1, 0.2]]"));
  const nlohmann::json of_methods = scores["method_families"].at(0);
  EXPECT_EQ(of_methods["options"], nlohmann::json({"by"}));
  EXPECT_EQ(of_methods["members"].back(), nlohmann::json::parse("[3, 2.0]"));
}

TEST_F(OfASweep, MethodsHaveTheStylesAndTheChoiceOfPlot) {
  const ReportContent content = read_report_content(folder_->path());
  const nlohmann::json scores = scores_json(content);
  const std::vector<std::string> shown = default_methods(content);
  Traces traces(content.store);
  const FigureData figures =
      sequence_figure_data(content.cells, traces, "b", shown, style_order(content));
  EXPECT_EQ(figures.curves.empty(), scores["default_methods"].empty());
  for (const DrawnCurve& curve : figures.curves) {
    if (curve.name == "reference") continue;
    const auto m = static_cast<std::size_t>(std::ranges::find(content.methods, curve.name) -
                                            content.methods.begin());
    EXPECT_EQ(scores["styles"][m]["color"], curve_style(curve.style).color) << curve.name;
    EXPECT_EQ(scores["styles"][m]["dash"], curve_style(curve.style).dash) << curve.name;
  }
  EXPECT_EQ(style_order(content).front(), "straight");  // the baseline
}

TEST_F(OfASweep, MethodsThatAreDrawnByDefaultShareNoColour) {
  ReportContent content = read_report_content(folder_->path());
  for (int i = 0; i < 20; ++i) {
    content.methods.insert(content.methods.begin() + 1, "other " + std::to_string(i));
  }
  const std::vector<std::string> order = style_order(content);
  EXPECT_EQ(order.size(), content.methods.size());
  std::set<std::string> colors;
  const std::vector<std::string> shown = default_methods(content);
  for (const std::string& name : shown) {
    const auto index = std::ranges::find(order, name) - order.begin();
    colors.insert(curve_style(static_cast<std::size_t>(index)).color);
  }
  EXPECT_EQ(colors.size(), shown.size());
}

TEST_F(OfASweep, StaysBelowItsSizeOrNamesTheLeast) {
  const std::size_t least = [&] {
    try {
      report_html(*content_, 1000);
    } catch (const InputError& error) {
      const std::string why = error.what();
      const std::size_t at = why.find("at least ") + 9;
      return static_cast<std::size_t>(std::llround(1e6 * std::stod(why.substr(at))));
    }
    return std::size_t{0};
  }();
  ASSERT_GT(least, 100'000u);
  EXPECT_LE(report_html(*content_, least).size(), least);
  EXPECT_THROW(report_html(*content_, least - 20'000), InputError);
}

TEST_F(OfASweep, FiguresHoldWhatHasATrace) {
  Traces traces(folder_->path());
  const FigureData figures = sequence_figure_data(
      content_->cells, traces, "b", {"straight", "broken", "<i>&"}, content_->methods);
  ASSERT_EQ(figures.curves.size(), 3u);  // the reference and two methods
  EXPECT_TRUE(figures.curves[0].columns.contains("x"));
  EXPECT_TRUE(figures.curves[1].columns.contains("error_x"));
  EXPECT_TRUE(sequence_figure_data(content_->cells, traces, "b", {"broken"}, content_->methods)
                  .curves.empty());
  EXPECT_EQ(file_stem("closed, 180 keyframes/../x"), "closed_180_keyframes_x");
  EXPECT_EQ(file_stem("..."), "");
}

TEST_F(OfASweep, AChromiumDrawsItWithoutAWordOfComplaint) {
  if (!test::has_chromium()) GTEST_SKIP() << "needs chromium";
  folder_->file("page.html", test::with_probe(*html_, "controls.js"));
  const std::string dom =
      test::in_browser(*folder_, "page.html", "--window-size=1400,2400 --dump-dom");
  EXPECT_TRUE(has(dom, "data-drawn=\"yes\""));
  EXPECT_EQ(test::title_of(dom), "probed: well");
}

}  // namespace
}  // namespace loopbench::tiny::report_test
