#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/core/fields.hpp"
#include "harness/base/hash.hpp"
#include "harness/compare/baseline_file.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

/// Identification of a score, without its numbers.
Json requested_score_json(const GateScore& s) {
  Json out{{"protocol", s.protocol.text()},
           {"times", s.times.text()},
           {"metric", s.metric.text()},
           {"label", s.label.text()},
           {"relation", s.relation.text()},
           {"axis", s.axis.text()},
           {"unit", s.unit.text()},
           {"better", to_text(s.better)}};
  if (s.better == metrics::Better::target) out["target"] = s.target;
  return out;
}

Json head(const GateCell& cell) {
  Json out{
      {"sequence", cell.sequence.text()}, {"repeat", cell.repeat}, {"method", cell.method.text()}};
  if (cell.oracle) out["oracle"] = true;
  if (cell.oracle_closures) out["oracle_data"] = true;
  out["status"] = to_text(cell.status);
  return out;
}

Json cell_json(const GateCell& cell,
               const std::vector<GateScore>& requested_scores,
               const std::vector<std::string>& statistics) {
  Json out = head(cell);
  if (cell.scores.empty()) return out;
  std::vector<const GateScore*> found;
  for (const GateScore& requested : requested_scores) {
    const auto same = std::ranges::find(
        cell.scores, name(requested), [](const GateScore& score) { return name(score); });
    found.push_back(same == cell.scores.end() ? nullptr : &*same);
  }
  const auto list = [&](auto entry) {
    Json values = Json::array();
    for (const GateScore* score : found) {
      values.push_back(score == nullptr ? Json(nullptr) : Json(entry(*score)));
    }
    return values;
  };
  const auto is_ok = [](const GateScore& score) { return score.status == Status::ok; };
  if (!std::ranges::all_of(cell.scores, is_ok)) {
    out["statuses"] = list([](const GateScore& score) { return to_text(score.status); });
  }
  const Json pairs = list([](const GateScore& score) { return score.pairs; });
  const Json possible = list([](const GateScore& score) { return score.possible; });
  const Json counts = list([](const GateScore& score) { return score.count; });
  out["pairs"] = pairs;
  if (possible != pairs) out["possible"] = possible;
  if (counts != pairs) out["counts"] = counts;
  for (const std::string& statistic : statistics) {
    out[statistic] = list([&](const GateScore& score) {
      return has_numbers(score.status) ? Json(score.values.at(statistic)) : Json(nullptr);
    });
  }
  return out;
}

Json written(const Tolerance& limit) {
  return {{"where", limit.where},
          {"values", limit.values},
          {"relative", limit.relative},
          {"absolute", limit.absolute}};
}

/// All statistics that have a limit.
std::vector<std::string> compared_statistics(const std::vector<Tolerance>& limits) {
  std::vector<std::string> out;
  for (const Tolerance& limit : limits) {
    for (const std::string& statistic : limit.values) {
      if (std::ranges::count(out, statistic) == 0) out.push_back(statistic);
    }
  }
  return out;
}

}  // namespace

std::string json(const Baseline& baseline) {
  std::vector<GateScore> requested_scores;
  std::map<std::string, bool> seen;
  for (const GateCell& cell : baseline.snapshot.cells) {
    for (const GateScore& score : cell.scores) {
      if (seen.emplace(name(score), true).second) requested_scores.push_back(score);
    }
  }
  const std::vector<std::string> statistics = compared_statistics(baseline.limits);
  const auto text = [](const Json& node) {
    return node.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  const auto lines = [&](const std::string& key, const std::vector<Json>& entries) {
    std::string out = "\"" + key + "\": [";
    for (std::size_t i = 0; i < entries.size(); ++i)
      out += (i == 0 ? "\n" : ",\n") + text(entries[i]);
    return out + "\n]";
  };
  std::vector<Json> limits;
  for (const Tolerance& limit : baseline.limits) limits.push_back(written(limit));
  std::vector<Json> scores;
  for (const GateScore& score : requested_scores) scores.push_back(requested_score_json(score));
  std::vector<Json> cells;
  for (const GateCell& cell : baseline.snapshot.cells) {
    cells.push_back(cell_json(cell, requested_scores, statistics));
  }
  const Snapshot& snapshot = baseline.snapshot;
  std::string out = fmt::format("{{\n\"loopbench_baseline\": {},\n", kBaselineFormat);
  const auto member = [&](const std::string& key, const Json& value) {
    out += "\"" + key + "\": " + text(value) + ",\n";
  };
  member("sweep", snapshot.sweep);
  member("build_summary", baseline.build_summary);
  member("machine", snapshot.machine);
  out += lines("limits", limits) + ",\n";
  member("sequences", snapshot.sequences);
  member("contents", snapshot.contents);
  member("protocols", snapshot.protocols);
  member("metrics", snapshot.metrics);
  member("methods", snapshot.methods);
  out += lines("scores", scores) + ",\n" + lines("cells", cells) + "\n}\n";
  out.insert(out.find('\n', 2) + 1, "\"digest\": \"" + digest_of(out) + "\",\n");
  return out;
}

std::string digest_of(const std::string& text) {
  Json root = Json::parse(text);
  root.erase("digest");
  root.erase("limits");
  return hex(hash_of(root.dump()));
}

}  // namespace loopbench::harness
