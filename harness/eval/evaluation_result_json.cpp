#include <nlohmann/json.hpp>

#include "harness/eval/evaluation_result.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Params& params) {
  Json out = Json::object();
  for (const auto& [name, param] : params) {
    out[name] = std::visit([](const auto& value) { return Json(value); }, param);
  }
  return out;
}

Json to_json(const EvaluatedMetric& metric, const metrics::Score& score) {
  const metrics::Statistics& s = score.statistics;
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

Json to_json(const EvaluationResult& result) {
  Json scores = Json::array();
  Json undefined = Json::array();
  Json failed = Json::array();
  Json diagnosis = Json::object();
  for (const metrics::Score& score : result.diagnosis)
    diagnosis[score.relation] = score.statistics.mean;
  for (const EvaluatedMetric& metric : result.metrics) {
    for (const metrics::Score& score : metric.scores) {
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
    const auto without_scores = [&](const std::string& why) -> Json {
      return {{"metric", metric.name}, {"options", to_json(metric.options)}, {"why", why}};
    };
    if (!metric.why_undefined.empty()) undefined.push_back(without_scores(metric.why_undefined));
    if (!metric.why_failed.empty()) failed.push_back(without_scores(metric.why_failed));
  }
  Json out{{"reference", result.reference},
           {"estimate", result.estimate},
           {"protocol",
            {{"name", result.protocol.name},
             {"version", result.protocol.version},
             {"changes", to_json(result.protocol.changes)},
             {"rules", to_json(echo(result.protocol.rules))}}},
           {"status", status(result)},
           {"why", why_not_ok(result)}};
  if (!result.reference_body.empty()) out["reference_body"] = result.reference_body;
  if (!result.other_body.empty()) out["other_body"] = result.other_body;
  if (result.why_failed.empty()) {
    out["pairs"] = result.coverage.pairs;
    out["possible"] = result.coverage.possible;
    out["coverage"] = result.coverage.share();
    out["span"] = result.coverage.span;
    out["alignment"] = {{"type", to_text(result.alignment.type)},
                        {"scale", result.alignment.scale},
                        {"rank", result.alignment.rank},
                        {"condition", result.alignment.condition}};
    out["diagnosis"] = std::move(diagnosis);
    out["notes"] = result.notes;
  }
  out["metrics"] = std::move(scores);
  out["undefined"] = std::move(undefined);
  out["failed"] = std::move(failed);
  return out;
}

}  // namespace

std::string json(const std::vector<EvaluationResult>& results) {
  Json all = Json::array();
  for (const EvaluationResult& result : results) all.push_back(to_json(result));
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names can be any bytes
}

}  // namespace loopbench::harness
