#include "harness/commands/judgement.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "metrics/diagnostics.hpp"

namespace loopbench {
namespace {

using Json = nlohmann::ordered_json;

/// The settings `eval` asks a metric for. Coverage stands above the table, once; metrics that need
/// more than two files, or a choice of options to mean something, are left to sweeps.
std::vector<Params> settings(const std::string& metric) {
  if (metric == "ate" || metric == "axis_error") return {Params{}};
  if (metric != "rpe") return {};
  return {{{"delta", 1.0}, {"unit", std::string("frames")}},
          {{"delta", 1.0}, {"unit", std::string("s")}},
          {{"delta", 1.0}, {"unit", std::string("m")}}};
}

Json to_json(const Params& params) {
  Json out = Json::object();
  for (const auto& [name, param] : params) {
    out[name] = std::visit([](const auto& value) { return Json(value); }, param);
  }
  return out;
}

Json to_json(const JudgedMetric& metric, const Score& score) {
  const Statistics& s = score.statistics;
  return {{"metric", metric.name},
          {"options", to_json(metric.options)},
          {"relation", score.relation},
          {"axis", score.axis},
          {"unit", score.unit},
          {"rmse", s.rmse},
          {"mean", s.mean},
          {"median", s.median},
          {"std", s.std},
          {"min", s.min},
          {"max", s.max},
          {"count", s.count}};
}

Json to_json(const Judgement& j) {
  Json scores = Json::array();
  Json undefined = Json::array();
  Json diagnosis = Json::object();
  for (const Score& score : j.diagnosis) diagnosis[score.relation] = score.statistics.mean;
  for (const JudgedMetric& metric : j.metrics) {
    for (const Score& score : metric.scores) {
      if (score.why_undefined.empty()) {
        scores.push_back(to_json(metric, score));
      } else {
        undefined.push_back({{"metric", metric.name},
                             {"options", to_json(metric.options)},
                             {"relation", score.relation},
                             {"axis", score.axis},
                             {"why", score.why_undefined}});
      }
    }
    if (metric.why_undefined.empty()) continue;
    undefined.push_back({{"metric", metric.name},
                         {"options", to_json(metric.options)},
                         {"why", metric.why_undefined}});
  }
  return {{"reference", j.reference},
          {"estimate", j.estimate},
          {"protocol", to_json(echo(j.protocol))},
          {"pairs", j.coverage.pairs},
          {"possible", j.coverage.possible},
          {"coverage", j.coverage.share()},
          {"span", j.coverage.span},
          {"alignment",
           {{"type", to_text(j.alignment.type)},
            {"scale", j.alignment.scale},
            {"rank", j.alignment.rank},
            {"condition", j.alignment.condition}}},
          {"diagnosis", std::move(diagnosis)},
          {"metrics", std::move(scores)},
          {"undefined", std::move(undefined)}};
}

/// "rpe 1 s": the options of a setting, short enough for a column.
std::string label(const JudgedMetric& metric) {
  if (metric.options.empty()) return metric.name;
  return fmt::format("{} {} {}",
                     metric.name,
                     std::get<double>(metric.options.at("delta")),
                     std::get<std::string>(metric.options.at("unit")));
}

/// "largest_gap 0.25 s, repeated 0, ...", a few a line.
std::string text(const std::vector<Score>& diagnosis) {
  std::string out;
  int count = 0;
  for (const Score& score : diagnosis) {
    const bool is_new_line = count++ % 4 == 0;
    out += is_new_line ? (out.empty() ? "diagnosis  " : ",\n           ") : ", ";
    out += fmt::format("{} {:.4g}", score.relation, score.statistics.mean);
    if (score.unit != "1") out += " " + score.unit;
  }
  return out + "\n";
}

}  // namespace

Judgement judge(const Trajectory& reference, const Trajectory& estimate, const Protocol& protocol) {
  Evaluation evaluation = evaluate(reference, estimate, protocol);
  evaluation.context = {.reference = &reference, .estimate = &estimate, .protocol = protocol};
  Judgement out;
  out.reference_poses = reference.size();
  out.estimate_poses = estimate.size();
  out.protocol = protocol;
  out.coverage = evaluation.coverage;
  out.alignment = evaluation.alignment;
  out.diagnosis = diagnostics(evaluation, {});
  for (const MetricEntry& entry : metrics()) {
    for (const Params& options : settings(entry.name)) {
      JudgedMetric& judged = out.metrics.emplace_back(JudgedMetric{entry.name, options, {}, {}});
      try {
        judged.scores = entry.score(evaluation, options);
      } catch (const std::runtime_error& error) {
        judged.why_undefined = error.what();
      }
    }
  }
  return out;
}

std::string text(const Judgement& j) {
  std::string out =
      fmt::format("reference  {} ({} poses)\n", j.reference, j.reference_poses) +
      fmt::format("estimate   {} ({} poses)\n", j.estimate, j.estimate_poses) +
      fmt::format("protocol   {}\n", to_text(echo(j.protocol))) +
      fmt::format("pairs      {} of {} ({:.1f} %), over {:.1f} % of the reference's time\n",
                  j.coverage.pairs,
                  j.coverage.possible,
                  100.0 * j.coverage.share(),
                  100.0 * j.coverage.span) +
      fmt::format("alignment  {}, scale {}\n", to_text(j.alignment.type), j.alignment.scale) +
      text(j.diagnosis) + "\n";
  const auto head = fmt::format("{:<13} {:<11} {:<4} {:<4}", "metric", "relation", "axis", "unit");
  out += head;
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max"}) {
    out += fmt::format(" {:>12}", name);
  }
  out += fmt::format(" {:>9}\n", "count");
  for (const JudgedMetric& metric : j.metrics) {
    if (!metric.why_undefined.empty()) {
      out += fmt::format("{:<13} undefined: {}\n", label(metric), metric.why_undefined);
    }
    for (const auto& [relation, axis, unit, s, why] : metric.scores) {
      if (!why.empty()) {
        out +=
            fmt::format("{:<13} {:<11} {:<4} undefined: {}\n", label(metric), relation, axis, why);
        continue;
      }
      out += fmt::format("{:<13} {:<11} {:<4} {:<4}", label(metric), relation, axis, unit);
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
        out += fmt::format(" {:>12.6f}", value);
      }
      out += fmt::format(" {:>9}\n", s.count);
    }
  }
  return out;
}

std::string json(const std::vector<Judgement>& judgements) {
  if (judgements.size() == 1) return to_json(judgements[0]).dump(2) + "\n";
  Json all = Json::array();
  for (const Judgement& judgement : judgements) all.push_back(to_json(judgement));
  return all.dump(2) + "\n";
}

}  // namespace loopbench
