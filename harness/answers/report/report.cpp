#include "harness/answers/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "datasets/core/error.hpp"
#include "harness/answers/report/data.hpp"
#include "harness/answers/report/page_template.hpp"
#include "harness/answers/report/sections.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// The library, then the page's own scripts in order of their dependencies, in elements with the
/// nonce of the policy.
std::string script_elements(const std::string& nonce) {
  // The licence requires its notice in all copies, so every report includes it.
  std::vector<std::string> scripts{"/*\n" + asset_text("assets/d3.LICENSE") + "*/\n" +
                                   asset_text("assets/d3.min.js")};
  std::istringstream names(
      "data state chart answer front pareto map ledger space along cut spread sweeps tables start");
  for (std::string name; names >> name;) {
    scripts.push_back("\n" + asset_text("page/" + name + ".js"));
  }
  std::string out;
  for (const std::string& script : scripts) {
    out += "<script nonce=\"" + nonce + "\">" + script + "</script>\n";
  }
  return out;
}

/// An element of the page's data, as script text.
std::string data_text(const char* name, const nlohmann::json& data) {
  return fmt::format(
      "\"{}\":{}",
      name,
      script_text(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

/// Name of the sweep; of evaluated files their sequence, or the number of sequences.
std::string title_of(const std::vector<std::string>& sequences,
                     std::map<std::string, std::string> run) {
  if (!is_of_files(run["config"])) return run.emplace("sweep", "sweep").first->second;
  return sequences.size() == 1 ? "Evaluation on " + sequences.front()
                               : fmt::format("Evaluation on {} sequences", sequences.size());
}

/// The smallest page, or the first that is smaller than `bytes`.
std::string thinned_html(const ReportContent& content, std::size_t bytes) {
  // As text, because the scores are most of a large report and need not be written again.
  const std::string data =
      data_text("scores", scores_json(content)) + "," +
      data_text("comparisons", nlohmann::json::parse(json(content.comparisons, -1))) + ",";
  // Content-Security-Policy: the page runs its own scripts only and loads nothing. No text of the
  // sweep can contain the nonce, a hash of all of them.
  const std::string nonce = hex(hash_of(data));
  Placeholders values{{"title", html_text(title_of(content.sequences, content.run))},
                      {"nonce", nonce},
                      {"style", "\n" + asset_text("page/report.css") + "\n"},
                      {"summary", summary_html(content)},
                      {"answers", answers_html(content)},
                      {"scores", scores_html(content)},
                      {"failures", failures_html(content)},
                      {"costs", costs_html(content)},
                      {"provenance", provenance_html(content)},
                      {"scripts", script_elements(nonce)}};
  std::size_t taken = data.size();
  for (const auto& [name, text] : values) taken += text.size();
  const std::vector<double> repeats = trace_bytes(content);
  const Thinning least = thinning_for(repeats, 0.0);
  const auto available = static_cast<double>(bytes - std::min(bytes, taken));
  double room = available;
  for (;;) {
    const Thinning thinning = thinning_for(repeats, room);
    values["data"] = "{" + data + data_text("traces", traces_json(content, thinning)) + "}";
    std::string html = filled(asset_text("page/report.html"), values);
    if (html.size() <= bytes || thinning == least) return html;
    const auto traces = static_cast<double>(html.size() - std::min(html.size(), taken));
    room *= std::min(0.95, available / std::max(1.0, traces));
  }
}

}  // namespace

std::string report_html(ReportContent content, std::size_t bytes) {
  for (;;) {
    std::string html = thinned_html(content, bytes);
    if (html.size() <= bytes) return html;
    if (content.shown < 2) {
      throw InputError(fmt::format("{}: the report needs at least {:.2f} MB, --size is {:.2f}",
                                   content.store.string(),
                                   std::ceil(1e-4 * static_cast<double>(html.size())) / 100.0,
                                   1e-6 * static_cast<double>(bytes)));
    }
    const double share = static_cast<double>(bytes) / static_cast<double>(html.size());
    const auto wanted = static_cast<std::size_t>(share * static_cast<double>(content.shown));
    content.show(std::clamp<std::size_t>(wanted, 1, content.shown - 1));
  }
}

}  // namespace loopbench::harness
