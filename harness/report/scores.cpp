#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "harness/plot/style.hpp"
#include "harness/report/data.hpp"
#include "harness/report/drawn_methods.hpp"

namespace loopbench::harness {
namespace {

std::string json_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : "null";
}

using ScoreKind =
    std::tuple<std::string, std::string, std::string, std::string, std::string, std::string>;

ScoreKind score_kind(const Record& r) {
  return {r.protocol, r.times, metric_label(r), r.relation, r.axis, r.unit};
}

std::string better_name(const Record& r) {
  for (const auto& [name, value] : choices(metrics::Better())) {
    if (value == r.better) return name;
  }
  return "neither";
}

}  // namespace

std::string scores_json(const ReportContent& content) {
  std::map<ScoreKind, std::size_t> index_of_kind;
  nlohmann::json kinds = nlohmann::json::array();
  std::map<std::int64_t, std::map<std::size_t, const Record*>> scores;  // by cell, by kind
  for (const Record& r : content.records) {
    if (r.metric.empty() || r.metric == "pairs" || r.metric == "time" || r.status != Status::ok)
      continue;
    const auto [found, is_new] = index_of_kind.emplace(score_kind(r), kinds.size());
    if (is_new) {
      kinds.push_back({{"label", field(r, "score")},
                       {"protocol", r.protocol},
                       {"times", r.times},
                       {"metric", metric_label(r)},
                       {"relation", r.relation},
                       {"axis", r.axis},
                       {"unit", r.unit},
                       {"better", better_name(r)}});
    }
    scores[r.cell][found->second] = &r;
  }
  std::map<std::string, std::size_t> sequence;
  std::map<std::string, std::size_t> method;
  for (const std::string& name : content.shown_sequences()) sequence.emplace(name, sequence.size());
  for (const std::string& name : content.methods) method.emplace(name, method.size());
  std::vector<bool> oracle(content.methods.size(), false);

  std::string cells;
  for (const CellRecord& cell : content.shown_cells) {
    const std::size_t m = method.at(cell.method);
    if (cell.oracle) oracle[m] = true;
    std::string values;
    const auto& own = scores[cell.position];
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto found = own.find(k);
      values += k == 0 ? "" : ",";
      if (found == own.end()) {
        values += "null";
        continue;
      }
      const metrics::Statistics& s = found->second->statistics;
      values += fmt::format("[{},{},{},{}]",
                            json_number(s.rmse),
                            json_number(s.mean),
                            json_number(s.median),
                            json_number(s.max));
    }
    cells += fmt::format("{}{{\"s\":{},\"m\":{},\"n\":{},\"st\":{},\"ms\":{},\"v\":[{}]}}",
                         cells.empty() ? "" : ",\n",
                         sequence.at(cell.sequence),
                         m,
                         cell.repeat,
                         json_text(to_text(cell.status)),
                         json_number(1e3 * cell.seconds),
                         values);
  }
  const std::vector<std::string> order = style_order(content);
  nlohmann::json styles = nlohmann::json::array();
  for (const std::string& name : content.methods) {
    const auto index = std::ranges::find(order, name) - order.begin();
    const CurveStyle style = curve_style(static_cast<std::size_t>(index));
    styles.push_back({{"color", style.color}, {"dash", style.dash}});
  }
  nlohmann::json usual = nlohmann::json::array();
  for (const std::string& name : usual_methods(content)) {
    if (const auto known = method.find(name); known != method.end()) usual.push_back(known->second);
  }
  const auto baseline = content.run.find("baseline");
  return fmt::format(
      "{{\"methods\":{},\"styles\":{},\"usual\":{},\"oracle\":{},\"sequences\":{},\"baseline\":{},"
      "\"statistics\":[\"rmse\",\"mean\",\"median\",\"max\"],\"kinds\":{},\"cells\":[{}]}}",
      json_text(content.methods),
      json_text(styles),
      json_text(usual),
      json_text(oracle),
      json_text(content.shown_sequences()),
      json_text(baseline == content.run.end() ? "" : baseline->second),
      json_text(kinds),
      cells);
}

}  // namespace loopbench::harness
