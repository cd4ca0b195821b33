#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "datasets/core/fields.hpp"
#include "harness/answers/gate/baseline.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

Json kind_json(const ScoreKind& kind) {
  Json out = Json::object();
  for (const KindField& each : kKindFields) out[each.name] = kind.*each.text;
  out["better"] = to_text(kind.better);
  if (kind.better == metrics::Better::target) out["target"] = kind.target;
  return out;
}

Json head(const Record& first) {
  const CellRow& cell = *first.cell;
  Json out{
      {"sequence", cell.sequence.text()}, {"repeat", cell.repeat}, {"method", cell.method.text()}};
  if (cell.oracle) out["oracle"] = true;
  if (cell.oracle_closures) out["oracle_data"] = true;
  out["status"] = to_text(first.has_score() ? Status::ok : first.status);
  return out;
}

/// [[5, 2], [7, 1]] for [5, 5, 7]: each value with the number of its repetitions.
Json repeated(const Json& values) {
  Json out = Json::array();
  for (const Json& value : values) {
    if (out.empty() || out.back().front() != value) out.push_back(Json::array({value, 0}));
    out.back().back() = out.back().back().get<int>() + 1;
  }
  return out;
}

/// The number with as few digits as `precision` allows.
double rounded(double number, const Rounding& precision) {
  const double error = precision.absolute + precision.relative * std::abs(number);
  if (!std::isfinite(number) || number == 0.0 || error == 0.0) return number;
  const double last = std::floor(std::log10(error));  // power of ten of the last digit
  const auto digits = static_cast<int>(std::floor(std::log10(std::abs(number))) - last);
  if (digits < 0) return 0.0;
  return digits > 16 ? number : std::stod(fmt::format("{:.{}e}", number, digits));
}

Json cell_json(std::span<const Record> cell,
               const std::vector<std::string>& names,
               const std::vector<std::string>& statistics,
               const Rounding& precision) {
  Json out = head(cell.front());
  if (!cell.front().has_score()) return out;
  std::map<std::string, const Record*> scores;
  for (const Record& score : cell) scores.emplace(score.kind->name(), &score);
  const auto list = [&](auto entry) {
    Json values = Json::array();
    for (const std::string& name : names) {
      const auto found = scores.find(name);
      values.push_back(found == scores.end() ? Json(nullptr) : Json(entry(*found->second)));
    }
    return values;
  };
  const auto is_ok = [](const Record& score) { return score.status == Status::ok; };
  if (!std::ranges::all_of(cell, is_ok)) {
    out["statuses"] = repeated(list([](const Record& score) { return to_text(score.status); }));
  }
  const Json pairs = list([](const Record& score) { return score.pairs; });
  const Json possible = list([](const Record& score) { return score.possible; });
  const Json counts = list(
      [](const Record& score) { return has_numbers(score.status) ? score.statistics.count : 0; });
  out["pairs"] = repeated(pairs);
  if (possible != pairs) out["possible"] = repeated(possible);
  if (counts != pairs) out["counts"] = repeated(counts);
  for (const std::string& statistic : statistics) {
    out[statistic] = list([&](const Record& score) {
      if (!has_numbers(score.status)) return Json(nullptr);
      return Json(rounded(value(score, statistic), precision));
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

/// A thousandth of the smallest limits.
Rounding precision_of(const std::vector<Tolerance>& limits) {
  if (limits.empty()) return {};
  return {std::ranges::min(limits, {}, &Tolerance::relative).relative * 0.001,
          std::ranges::min(limits, {}, &Tolerance::absolute).absolute * 0.001};
}

}  // namespace

std::string json(const Baseline& baseline) {
  std::vector<std::string> names;
  std::vector<Json> scores;
  std::set<std::string> seen;
  for (const Record& score : baseline.snapshot.records) {
    std::string name = score.has_score() ? score.kind->name() : "";
    if (name.empty() || !seen.insert(name).second) continue;
    names.push_back(std::move(name));
    scores.push_back(kind_json(*score.kind));
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
  std::vector<Json> cells;
  const Rounding precision = precision_of(baseline.limits);
  for (const std::span<const Record> cell : by_cell(baseline.snapshot.records)) {
    cells.push_back(cell_json(cell, names, statistics, precision));
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
  member("precision", {{"relative", precision.relative}, {"absolute", precision.absolute}});
  for (const DefinitionKind& each : kDefinitions) member(each.name, snapshot.*each.member);
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
