#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "harness/export/gate.hpp"
#include "harness/export/where.hpp"

namespace loopbench {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormat = 2;

/// The question of a score, without its answer.
Json question(const GateScore& s) {
  return {{"protocol", s.protocol},
          {"times", s.times},
          {"metric", s.metric},
          {"relation", s.relation},
          {"axis", s.axis},
          {"unit", s.unit}};
}

Json answers(const GateCell& cell,
             const std::vector<GateScore>& questions,
             const std::vector<std::string>& statistics) {
  Json out{{"sequence", cell.sequence},
           {"repeat", cell.repeat},
           {"method", cell.method},
           {"status", cell.status}};
  if (cell.scores.empty()) return out;
  std::vector<const GateScore*> found;
  for (const GateScore& asked : questions) {
    const auto same = std::ranges::find(
        cell.scores, name(asked), [](const GateScore& score) { return name(score); });
    found.push_back(same == cell.scores.end() ? nullptr : &*same);
  }
  const auto list = [&](auto entry) {
    Json values = Json::array();
    for (const GateScore* score : found) {
      values.push_back(score == nullptr        ? Json(nullptr)
                       : score->status != "ok" ? Json(score->status)
                                               : Json(entry(*score)));
    }
    return values;
  };
  out["pairs"] = list([](const GateScore& score) { return score.pairs; });
  for (const std::string& statistic : statistics) {
    out[statistic] = list([&](const GateScore& score) { return score.values.at(statistic); });
  }
  return out;
}

Json written(const Tolerance& limit) {
  Json out{{"where", limit.where},
           {"value", limit.value},
           {"relative", limit.relative},
           {"absolute", limit.absolute},
           {"tie", limit.tie}};
  if (limit.alpha) out["alpha"] = *limit.alpha;
  return out;
}

/// Walks a baseline; every complaint names the place.
class BaselineReader {
 public:
  explicit BaselineReader(std::string file) : file_(std::move(file)) {}

  Baseline read(const Json& root) {
    const Json& format = member(root, "loopbench_baseline", "");
    if (format != kFormat) {
      refuse("loopbench_baseline",
             fmt::format("is {}, expected {}; --update writes it anew", format.dump(), kFormat));
    }
    Baseline out;
    out.snapshot.sweep = text(root, "sweep", "");
    out.made_by = texts(root, "made_by");
    out.snapshot.sequences = texts(root, "sequences");
    out.snapshot.protocols = texts(root, "protocols");
    out.limits = limits(root);
    each(root, "scores", [&](const Json& entry, const std::string& at) {
      questions_.push_back({text(entry, "protocol", at),
                            text(entry, "times", at),
                            text(entry, "metric", at),
                            text(entry, "relation", at),
                            text(entry, "axis", at),
                            text(entry, "unit", at),
                            "ok",
                            0,
                            {}});
    });
    each(root, "cells", [&](const Json& entry, const std::string& at) {
      out.snapshot.cells.push_back(cell(entry, at, out.limits));
    });
    return out;
  }

  std::vector<Tolerance> limits(const Json& root) const {
    std::vector<Tolerance> out;
    each(root, "limits", [&](const Json& entry, const std::string& at) {
      out.push_back(limit(entry, at));
    });
    return out;
  }

 private:
  [[noreturn]] void refuse(const std::string& at, const std::string& what) const {
    throw InputError(file_ + ": " + at + ": " + what);
  }

  const Json& member(const Json& node, const std::string& key, const std::string& at) const {
    const std::string place = at.empty() ? "" : at;
    if (!node.is_object()) refuse(place.empty() ? "baseline" : place, "expected an object");
    const auto found = node.find(key);
    if (found == node.end()) refuse(place + (place.empty() ? "" : ".") + key, "is missing");
    return *found;
  }

  std::string text(const Json& node, const std::string& key, const std::string& at) const {
    const Json& found = member(node, key, at);
    if (!found.is_string()) refuse(at + "." + key, "expected text, found " + found.dump());
    return found.get<std::string>();
  }

  double number(const Json& node, const std::string& key, const std::string& at) const {
    const Json& found = member(node, key, at);
    if (!found.is_number() || found.get<double>() < 0.0) {
      refuse(at + "." + key, "expected a number, not negative, found " + found.dump());
    }
    return found.get<double>();
  }

  std::map<std::string, std::string> texts(const Json& root, const std::string& key) const {
    std::map<std::string, std::string> out;
    const Json& node = member(root, key, "");
    if (!node.is_object()) refuse(key, "expected an object");
    for (const auto& [name, value] : node.items()) out[name] = text(node, name, key);
    return out;
  }

  template <class Each>
  void each(const Json& root, const std::string& key, Each act) const {
    const Json& node = member(root, key, "");
    if (!node.is_array()) refuse(key, "expected a list");
    for (std::size_t i = 0; i < node.size(); ++i) act(node[i], fmt::format("{}[{}]", key, i));
  }

  Tolerance limit(const Json& node, const std::string& at) const {
    Tolerance out;
    const Json& rules = member(node, "where", at);
    if (!rules.is_array()) refuse(at + ".where", "expected a list");
    for (const Json& rule : rules) {
      if (!rule.is_string()) refuse(at + ".where", "expected text, found " + rule.dump());
      out.where.push_back(rule.get<std::string>());
    }
    out.value = text(node, "value", at);
    try {
      where(out.where);
      value(Record{}, out.value);
    } catch (const InputError& error) {
      refuse(at, error.what());
    }
    out.relative = number(node, "relative", at);
    out.absolute = number(node, "absolute", at);
    out.tie = number(node, "tie", at);
    out.alpha.reset();
    if (node.contains("alpha")) out.alpha = number(node, "alpha", at);
    return out;
  }

  GateCell cell(const Json& node,
                const std::string& at,
                const std::vector<Tolerance>& limits) const {
    GateCell out{text(node, "sequence", at), 0, text(node, "method", at), "", {}};
    out.repeat = static_cast<std::int64_t>(number(node, "repeat", at));
    out.status = text(node, "status", at);
    if (!node.contains("pairs")) return out;
    const auto list = [&](const std::string& key) -> const Json& {
      const Json& found = member(node, key, at);
      if (!found.is_array() || found.size() != questions_.size()) {
        refuse(at + "." + key, fmt::format("expected a list of {}, as scores", questions_.size()));
      }
      return found;
    };
    const Json& pairs = list("pairs");
    for (std::size_t i = 0; i < questions_.size(); ++i) {
      if (pairs[i].is_null()) continue;
      GateScore score = questions_[i];
      if (pairs[i].is_string()) {
        score.status = pairs[i].get<std::string>();
      } else if (pairs[i].is_number_integer()) {
        score.pairs = pairs[i].get<std::int64_t>();
        for (const Tolerance& limit : limits) {
          const Json& entry = list(limit.value)[i];
          if (!entry.is_number()) {
            refuse(fmt::format("{}.{}[{}]", at, limit.value, i),
                   "expected a number, found " + entry.dump());
          }
          score.values[limit.value] = entry.get<double>();
        }
      } else {
        refuse(fmt::format("{}.pairs[{}]", at, i), "expected a whole number or a status");
      }
      out.scores.push_back(std::move(score));
    }
    return out;
  }

  std::string file_;
  std::vector<GateScore> questions_;
};

}  // namespace

std::string json(const Baseline& baseline) {
  std::vector<GateScore> questions;
  std::map<std::string, bool> asked;
  for (const GateCell& cell : baseline.snapshot.cells) {
    for (const GateScore& score : cell.scores) {
      if (asked.emplace(name(score), true).second) questions.push_back(score);
    }
  }
  std::vector<std::string> statistics;
  for (const Tolerance& limit : baseline.limits) {
    if (std::ranges::count(statistics, limit.value) == 0) statistics.push_back(limit.value);
  }
  const auto line = [](const Json& node) {
    return node.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  const auto lines = [&](const std::string& key, const std::vector<Json>& entries) {
    std::string out = "\"" + key + "\": [";
    for (std::size_t i = 0; i < entries.size(); ++i)
      out += (i == 0 ? "\n" : ",\n") + line(entries[i]);
    return out + "\n]";
  };
  std::vector<Json> limits;
  for (const Tolerance& limit : baseline.limits) limits.push_back(written(limit));
  std::vector<Json> scores;
  for (const GateScore& score : questions) scores.push_back(question(score));
  std::vector<Json> cells;
  for (const GateCell& cell : baseline.snapshot.cells) {
    cells.push_back(answers(cell, questions, statistics));
  }
  std::string out = "{\n";
  out += fmt::format("\"loopbench_baseline\": {},\n", kFormat);
  out += "\"sweep\": " + line(baseline.snapshot.sweep) + ",\n";
  out += "\"made_by\": " + line(baseline.made_by) + ",\n";
  out += lines("limits", limits) + ",\n";
  out += "\"sequences\": " + line(baseline.snapshot.sequences) + ",\n";
  out += "\"protocols\": " + line(baseline.snapshot.protocols) + ",\n";
  return out + lines("scores", scores) + ",\n" + lines("cells", cells) + "\n}\n";
}

namespace {

Json parsed(const std::string& text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = static_cast<std::size_t>(1 + std::count(text.begin(), end, '\n'));
    const std::string what = error.what();  // "[json.exception...] parse error at ...: the reason"
    const std::size_t reason = what.find(": ");
    throw input_error(
        file,
        line,
        "is not JSON: " + (reason == std::string::npos ? what : what.substr(reason + 2)));
  }
}

std::string baseline_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) {
    throw InputError(file.string() + ": cannot be read, expected a baseline (--update writes one)");
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

Baseline parse_baseline(const std::string& text, const std::string& file) {
  return BaselineReader(file).read(parsed(text, file));
}

Baseline read_baseline(const std::filesystem::path& file) {
  return parse_baseline(baseline_text(file), file.string());
}

std::vector<Tolerance> read_limits(const std::filesystem::path& file) {
  return BaselineReader(file.string()).limits(parsed(baseline_text(file), file.string()));
}

}  // namespace loopbench
