#include <fmt/format.h>

#include "harness/eval/evaluation_result.hpp"
#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

std::string head(const EvaluationResult& result) {
  return quoted(result.reference) + "," + quoted(result.estimate) + "," +
         quoted(result.protocol.label()) + "," + quoted(result.protocol.version);
}

}  // namespace

std::string csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,metric,options,relation,axis,unit,count,rmse,"
      "mean,median,std,min,max,sse,pairs,possible,scale,status,why,reference_body\n";
  for (const EvaluationResult& result : results) {
    const std::string body = quoted(result.reference_body);
    if (!result.why_failed.empty()) {
      out +=
          head(result) + ",,,,,,,,,,,,,,,,,failed," + quoted(result.why_failed) + "," + body + "\n";
    }
    const std::string tail = fmt::format(
        "{},{},{}", result.coverage.pairs, result.coverage.possible, result.alignment.scale);
    for (const EvaluatedMetric& metric : result.metrics) {
      const std::string front =
          head(result) + "," + metric.name + "," + quoted(to_text(metric.options));
      for (const auto& [relation, axis, unit, s, why, better, target] : metric.scores) {
        if (!why.empty()) {
          out += fmt::format("{},{},{},{},,,,,,,,,{},undefined,{},{}\n",
                             front,
                             relation,
                             axis,
                             unit,
                             tail,
                             quoted(why),
                             body);
          continue;
        }
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                           front,
                           relation,
                           axis,
                           unit,
                           s.count,
                           s.rmse,
                           s.mean,
                           s.median,
                           s.std,
                           s.min,
                           s.max,
                           s.sse,
                           tail,
                           result.incomplete_reason.empty() ? "ok" : "incomplete",
                           quoted(result.incomplete_reason),
                           body);
      }
      for (const auto& [status, why] :
           {std::pair{"undefined", metric.why_undefined}, std::pair{"failed", metric.why_failed}}) {
        if (why.empty()) continue;
        out += fmt::format("{},,,,,,,,,,,,{},{},{},{}\n", front, tail, status, quoted(why), body);
      }
    }
  }
  return out;
}

std::string pose_csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,stamp,estimate_stamp,x_m,y_m,z_m,distance_m,"
      "rx_rad,ry_rad,rz_rad,angle_rad\n";
  for (const EvaluationResult& result : results) {
    const std::string front = head(result);
    for (const auto& [stamp, estimate_stamp, e, r] : result.poses) {
      out += fmt::format(
          "{},{},{},{},{},{},{}", front, stamp, estimate_stamp, e.x(), e.y(), e.z(), e.norm());
      out += r.hasNaN() ? std::string(",,,,\n")
                        : fmt::format(",{},{},{},{}\n", r.x(), r.y(), r.z(), r.norm());
    }
  }
  return out;
}

}  // namespace loopbench::harness
