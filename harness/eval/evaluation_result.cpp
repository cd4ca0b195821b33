#include "harness/eval/evaluation_result.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/tables/record_csv.hpp"

namespace loopbench::harness {
namespace {

/// The first record whose metric failed; null if there is none.
const Record* failed_metric(const EvaluationResult& result) {
  const auto found = std::ranges::find_if(
      result.records, [](const Record& record) { return is_failure(record.status); });
  return found == result.records.end() ? nullptr : &*found;
}

bool has_no_number(const EvaluationResult& result) {
  return std::ranges::none_of(result.records,
                              [](const Record& record) { return has_numbers(record.status); });
}

}  // namespace

std::string status(const EvaluationResult& result) {
  if (!result.why_failed.empty()) return "failed";
  if (has_no_number(result)) return failed_metric(result) != nullptr ? "failed" : "undefined";
  return result.incomplete_reason.empty() ? "ok" : "incomplete";
}

std::string why_not_ok(const EvaluationResult& result) {
  if (!result.why_failed.empty()) return result.why_failed;
  if (!has_no_number(result)) return result.incomplete_reason;
  const Record* failed = failed_metric(result);
  return failed != nullptr ? failed->why : "none of the requested metrics is defined";
}

std::vector<Record> all_records(const std::vector<EvaluationResult>& results) {
  std::vector<Record> out;
  for (const EvaluationResult& result : results) {
    out.insert(out.end(), result.records.begin(), result.records.end());
  }
  return out;
}

std::string pose_csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,stamp,estimate_stamp,x_m,y_m,z_m,distance_m,"
      "rx_rad,ry_rad,rz_rad,angle_rad\n";
  for (const EvaluationResult& result : results) {
    const std::string front = quoted(result.reference) + "," + quoted(result.estimate) + "," +
                              quoted(result.protocol.label()) + "," +
                              quoted(result.protocol.version);
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
