#include "harness/commands/eval/evaluation_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "harness/answers/notes/note_json.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "metrics/numerics/angle.hpp"

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

Json to_json(const Record& record) {
  Json out{{"metric", std::string(record.kind->metric)},
           {"label", std::string(record.kind->label)}};
  if (!record.kind->relation.empty()) {
    out["relation"] = std::string(record.kind->relation);
    out["axis"] = std::string(record.kind->axis);
  }
  if (!has_numbers(record.status)) {
    out["why"] = std::string(record.why);
    return out;
  }
  const metrics::Statistics& s = record.statistics;
  out["unit"] = std::string(record.kind->unit);
  for (const auto& each : metrics::kStatisticFields) {
    if (has_direction(each.name)) out[each.name] = s.*each.member;
  }
  out["count"] = s.count;
  return out;
}

Json to_json(const metrics::Alignment& alignment) {
  const auto& [rotation, position] = alignment.reference_from_estimate;
  return {{"type", to_text(alignment.type)},
          {"scale", alignment.scale},
          {"rank", alignment.rank},
          {"condition", alignment.condition},
          {"x", position.x()},
          {"y", position.y()},
          {"z", position.z()},
          {"qx", rotation.x()},
          {"qy", rotation.y()},
          {"qz", rotation.z()},
          {"qw", rotation.w()}};
}

Json to_json(const EvaluationResult& result) {
  Json scores = Json::array();
  Json undefined = Json::array();
  Json failed = Json::array();
  for (const Record& record : result.records) {
    Json& without = is_failure(record.status) ? failed : undefined;
    Json& list = has_numbers(record.status) ? scores : without;
    list.push_back(to_json(record));
  }
  const auto [status, why] = status_of(result);
  Json out{{"reference", result.reference},
           {"estimate", result.estimate},
           {"protocol",
            {{"name", result.protocol.name},
             {"version", result.protocol.version},
             {"changes", to_json(result.protocol.changes)},
             {"rules", to_json(echo(result.protocol.rules))}}},
           {"status", status},
           {"why", why}};
  if (!result.reference_body.empty()) out["reference_body"] = result.reference_body;
  if (!result.other_body.empty()) out["other_body"] = result.other_body;
  if (result.why_failed.empty()) {
    Json diagnosis = Json::object();
    for (const metrics::Score& score : result.diagnosis)
      diagnosis[score.relation] = score.statistics.mean;
    out["pairs"] = result.coverage.pairs;
    out["possible"] = result.coverage.possible;
    out["coverage"] = result.coverage.share();
    out["span"] = result.coverage.span;
    out["alignment"] = to_json(result.alignment);
    out["diagnosis"] = std::move(diagnosis);
    out["notes"] = texts(result.notes);
    out["facts"] = Json::array();
    for (const Note& note : result.notes) out["facts"].push_back(to_json(note));
  }
  out["metrics"] = std::move(scores);
  out["undefined"] = std::move(undefined);
  out["failed"] = std::move(failed);
  return out;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names can be any bytes
}

/// Each once.
std::vector<std::string> stated_columns(const std::vector<EvaluationResult>& results) {
  std::vector<std::string> out;
  for (const EvaluationResult& result : results) {
    for (const PoseValues& each : result.pose_values) {
      if (std::ranges::count(out, column_name(each)) == 0) out.push_back(column_name(each));
    }
  }
  return out;
}

}  // namespace

std::string column_name(const PoseValues& values) { return values.name + "_" + values.unit; }

std::pair<std::string, std::string> status_of(const EvaluationResult& result) {
  if (!result.why_failed.empty()) return {"failed", result.why_failed};
  const std::string& incomplete = result.incomplete_reason;
  for (const Record& record : result.records) {
    if (has_numbers(record.status)) return {incomplete.empty() ? "ok" : "incomplete", incomplete};
  }
  for (const Record& record : result.records) {
    if (is_failure(record.status)) return {"failed", record.why};
  }
  return {"undefined", "none of the requested metrics is defined"};
}

void change_unit(std::vector<Record>& records, const std::string& unit) {
  static const std::map<std::string, double> kLengths{
      {"mm", 1e3}, {"cm", 1e2}, {"m", 1.0}, {"km", 1e-3}};
  static const std::map<std::string, double> kAngles{{"deg", metrics::kDegrees}, {"rad", 1.0}};
  const auto& units = kLengths.contains(unit) ? kLengths : kAngles;
  if (!units.contains(unit)) {
    throw InputError("--unit: found '" + unit + "', expected mm, cm, m, km, deg or rad");
  }
  bool is_used = false;
  for (Record& record : records) {
    const auto from = units.find(record.kind->unit);
    if (from == units.end()) continue;
    const double factor = units.at(unit) / from->second;
    is_used = true;
    record.kind.edit().unit = unit;
    metrics::Statistics& s = record.statistics;
    for (const auto& each : metrics::kStatisticFields) s.*each.member *= factor;
    s.sse *= factor;  // has the squared unit
  }
  if (is_used) return;
  throw InputError("--unit " + unit + ": no score is " +
                   (&units == &kLengths ? "a length" : "an angle"));
}

std::string json(const std::vector<EvaluationResult>& results) {
  Json all = Json::array();
  for (const EvaluationResult& result : results) all.push_back(to_json(result));
  return json_text(all);
}

std::string json(const std::vector<AlignedFile>& files) {
  Json all = Json::array();
  for (const AlignedFile& file : files) {
    all.push_back({{"reference", file.reference},
                   {"estimate", file.estimate},
                   {"pairs", file.pairs},
                   {"alignment", to_json(file.alignment)}});
  }
  return json_text(all);
}

std::string pose_csv(const std::vector<EvaluationResult>& results) {
  std::string out =
      "reference,estimate,protocol,protocol_version,stamp,estimate_stamp,x_m,y_m,z_m,distance_m,"
      "rx_rad,ry_rad,rz_rad,angle_rad";
  const std::vector<std::string> stated = stated_columns(results);
  for (const std::string& column : stated) out += "," + quoted(column);
  out += '\n';
  for (const EvaluationResult& result : results) {
    std::vector<const PoseValues*> values(stated.size());
    for (const PoseValues& each : result.pose_values) {
      const auto place = std::ranges::find(stated, column_name(each)) - stated.begin();
      values[static_cast<std::size_t>(place)] = &each;
    }
    const std::string front = quoted(result.reference) + "," + quoted(result.estimate) + "," +
                              quoted(result.protocol.label()) + "," +
                              quoted(result.protocol.version);
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
      const auto& [stamp, estimate_stamp, e, r] = result.poses[i];
      out += fmt::format(
          "{},{},{},{},{},{},{}", front, stamp, estimate_stamp, e.x(), e.y(), e.z(), e.norm());
      out += r.hasNaN() ? std::string(",,,,")
                        : fmt::format(",{},{},{},{}", r.x(), r.y(), r.z(), r.norm());
      for (const PoseValues* each : values) {
        out += each == nullptr ? "," : fmt::format(",{}", each->values[i]);
      }
      out += '\n';
    }
  }
  return out;
}

}  // namespace loopbench::harness
