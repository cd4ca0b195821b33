#include <fmt/format.h>

#include "harness/eval/evaluation_result.hpp"
#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

std::string head(const EvaluationResult& j) {
  return quoted(j.reference) + "," + quoted(j.estimate) + "," + quoted(j.protocol.label()) + "," +
         quoted(j.protocol.version);
}

}  // namespace

std::string csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,metric,options,relation,axis,unit,count,rmse,"
      "mean,median,std,min,max,sse,pairs,possible,scale,status,why,reference_body\n";
  for (const EvaluationResult& j : results) {
    const std::string body = quoted(j.reference_body);
    if (!j.why_failed.empty()) {
      out += head(j) + ",,,,,,,,,,,,,,,,,failed," + quoted(j.why_failed) + "," + body + "\n";
    }
    const std::string tail =
        fmt::format("{},{},{}", j.coverage.pairs, j.coverage.possible, j.alignment.scale);
    for (const EvaluatedMetric& metric : j.metrics) {
      const std::string front = head(j) + "," + metric.name + "," + quoted(to_text(metric.options));
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
                           j.incomplete_reason.empty() ? "ok" : "incomplete",
                           quoted(j.incomplete_reason),
                           body);
      }
      if (metric.why_undefined.empty()) continue;
      out += fmt::format(
          "{},,,,,,,,,,,,{},undefined,{},{}\n", front, tail, quoted(metric.why_undefined), body);
    }
  }
  return out;
}

std::string pose_csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,stamp,estimate_stamp,x_m,y_m,z_m,distance_m,"
      "rx_rad,ry_rad,rz_rad,angle_rad\n";
  for (const EvaluationResult& j : results) {
    const std::string front = head(j);
    for (const auto& [stamp, estimate_stamp, e, r] : j.poses) {
      out += fmt::format(
          "{},{},{},{},{},{},{}", front, stamp, estimate_stamp, e.x(), e.y(), e.z(), e.norm());
      out += r.hasNaN() ? std::string(",,,,\n")
                        : fmt::format(",{},{},{},{}\n", r.x(), r.y(), r.z(), r.norm());
    }
  }
  return out;
}

}  // namespace loopbench::harness
