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

Json to_json(const EvaluationResult& j) {
  Json scores = Json::array();
  Json undefined = Json::array();
  Json diagnosis = Json::object();
  for (const metrics::Score& score : j.diagnosis) diagnosis[score.relation] = score.statistics.mean;
  for (const EvaluatedMetric& metric : j.metrics) {
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
    if (metric.why_undefined.empty()) continue;
    undefined.push_back({{"metric", metric.name},
                         {"options", to_json(metric.options)},
                         {"why", metric.why_undefined}});
  }
  Json out{{"reference", j.reference},
           {"estimate", j.estimate},
           {"protocol",
            {{"name", j.protocol.name},
             {"version", j.protocol.version},
             {"changes", to_json(j.protocol.changes)},
             {"rules", to_json(echo(j.protocol.rules))}}},
           {"status", status(j)},
           {"why", why_not_ok(j)}};
  if (!j.reference_body.empty()) out["reference_body"] = j.reference_body;
  if (!j.other_body.empty()) out["other_body"] = j.other_body;
  if (j.why_failed.empty()) {
    out["pairs"] = j.coverage.pairs;
    out["possible"] = j.coverage.possible;
    out["coverage"] = j.coverage.share();
    out["span"] = j.coverage.span;
    out["alignment"] = {{"type", to_text(j.alignment.type)},
                        {"scale", j.alignment.scale},
                        {"rank", j.alignment.rank},
                        {"condition", j.alignment.condition}};
    out["diagnosis"] = std::move(diagnosis);
    out["notes"] = j.notes;
  }
  out["metrics"] = std::move(scores);
  out["undefined"] = std::move(undefined);
  return out;
}

}  // namespace

std::string json(const std::vector<EvaluationResult>& results) {
  Json all = Json::array();
  for (const EvaluationResult& result : results) all.push_back(to_json(result));
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names can be any bytes
}

}  // namespace loopbench::harness
