#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/gate/formats.hpp"
#include "harness/model/where.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

/// Parses a baseline; messages name the JSON path.
class BaselineReader {
 public:
  explicit BaselineReader(std::string file) : file_(std::move(file)) {}

  Baseline read(const Json& root) {
    const Json& format = member(root, "loopbench_baseline", "");
    if (format != kBaselineFormat) {
      reject("loopbench_baseline",
             fmt::format("found format {}, expected {}: it lacks data that format {} compares; "
                         "check the results, then write it again with --update (limits are kept)",
                         format.dump(),
                         kBaselineFormat,
                         kBaselineFormat));
    }
    Baseline out;
    out.build_summary = texts(root, "build_summary");
    out.limits = limits(root);
    out.snapshot.sweep = text(root, "sweep", "");
    out.snapshot.machine = text(root, "machine", "");
    out.snapshot.sequences = texts(root, "sequences");
    out.snapshot.contents = texts(root, "contents");
    out.snapshot.protocols = texts(root, "protocols");
    out.snapshot.metrics = texts(root, "metrics");
    out.snapshot.methods = texts(root, "methods");
    each(root, "scores", [&](const Json& entry, const std::string& at) {
      requested_scores_.push_back(requested_score(entry, at));
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
  [[noreturn]] void reject(const std::string& at, const std::string& what) const {
    throw InputError(file_ + ": " + at + ": " + what);
  }

  const Json& member(const Json& node, const std::string& key, const std::string& at) const {
    const std::string location = at.empty() ? "" : at;
    if (!node.is_object()) reject(location.empty() ? "baseline" : location, "expected an object");
    const auto found = node.find(key);
    if (found == node.end()) reject(location + (location.empty() ? "" : ".") + key, "is missing");
    return *found;
  }

  std::string text(const Json& node, const std::string& key, const std::string& at) const {
    const Json& found = member(node, key, at);
    if (!found.is_string()) reject(at + "." + key, "expected text, found " + found.dump());
    return found.get<std::string>();
  }

  Status status_of(const Json& node, const std::string& at) const {
    const auto status =
        node.is_string() ? from_text<Status>(node.get<std::string>()) : std::nullopt;
    if (!status) reject(at, "expected " + choice_list<Status>() + ", found " + node.dump());
    return *status;
  }

  double number(const Json& node, const std::string& key, const std::string& at) const {
    const Json& found = member(node, key, at);
    if (!found.is_number() || found.get<double>() < 0.0) {
      reject(at + "." + key, "expected a non-negative number, found " + found.dump());
    }
    return found.get<double>();
  }

  std::map<std::string, std::string> texts(const Json& root, const std::string& key) const {
    std::map<std::string, std::string> out;
    const Json& node = member(root, key, "");
    if (!node.is_object()) reject(key, "expected an object");
    for (const auto& [name, value] : node.items()) out[name] = text(node, name, key);
    return out;
  }

  template <class Each>
  void each(const Json& root, const std::string& key, Each act) const {
    const Json& node = member(root, key, "");
    if (!node.is_array()) reject(key, "expected a list");
    for (std::size_t i = 0; i < node.size(); ++i) act(node[i], fmt::format("{}[{}]", key, i));
  }

  /// A misspelt key would be a limit that is not applied.
  void reject_unknown_keys(const Json& node, const std::string& at) const {
    static const std::vector<std::string> known{
        "where", "value", "values", "relative", "absolute", "tie", "alpha"};
    for (const auto& entry : node.items()) {
      if (std::ranges::count(known, entry.key()) > 0) continue;
      reject(at, unknown_name("key of a limit", entry.key(), known));
    }
  }

  Tolerance limit(const Json& node, const std::string& at) const {
    Tolerance out;
    if (node.is_object()) reject_unknown_keys(node, at);
    const Json& rules = member(node, "where", at);
    if (!rules.is_array()) reject(at + ".where", "expected a list");
    for (const Json& rule : rules) {
      if (!rule.is_string()) reject(at + ".where", "expected text, found " + rule.dump());
      out.where.push_back(rule.get<std::string>());
    }
    out.values = statistics(node, at);
    try {
      where(out.where);
      for (const std::string& statistic : out.values) value(Record{}, statistic);
    } catch (const InputError& error) {
      reject(at, error.what());
    }
    out.relative = number(node, "relative", at);
    out.absolute = number(node, "absolute", at);
    out.tie = number(node, "tie", at);
    out.alpha.reset();
    if (node.contains("alpha")) out.alpha = number(node, "alpha", at);
    return out;
  }

  /// Until format 2 a limit had one `value`, usually rmse, and did not check the maximum.
  std::vector<std::string> statistics(const Json& node, const std::string& at) const {
    if (node.contains("value")) {
      const std::string only = text(node, "value", at);
      return only == "rmse" ? Tolerance{}.values : std::vector<std::string>{only};
    }
    const Json& found = member(node, "values", at);
    std::vector<std::string> out;
    if (found.is_array()) {
      for (const Json& entry : found) {
        if (entry.is_string()) out.push_back(entry.get<std::string>());
      }
    }
    if (out.empty() || out.size() != found.size()) {
      reject(at + ".values", "expected a list of statistics, found " + found.dump());
    }
    return out;
  }

  GateScore requested_score(const Json& node, const std::string& at) const {
    GateScore out;
    out.protocol = text(node, "protocol", at);
    out.times = text(node, "times", at);
    out.metric = text(node, "metric", at);
    out.label = text(node, "label", at);
    out.relation = text(node, "relation", at);
    out.axis = text(node, "axis", at);
    out.unit = text(node, "unit", at);
    const auto better = from_text<metrics::Better>(text(node, "better", at));
    if (!better) reject(at + ".better", "expected " + choice_list<metrics::Better>());
    out.better = *better;
    const auto target = node.find("target");
    if (target != node.end() && target->is_number()) out.target = target->get<double>();
    return out;
  }

  bool flag(const Json& node, const std::string& key) const {
    const auto found = node.find(key);
    return found != node.end() && found->is_boolean() && found->get<bool>();
  }

  const Json& list(const Json& node, const std::string& key, const std::string& at) const {
    const Json& found = member(node, key, at);
    if (!found.is_array() || found.size() != requested_scores_.size()) {
      reject(at + "." + key,
             fmt::format("expected a list of {}, as scores", requested_scores_.size()));
    }
    return found;
  }

  std::int64_t integer(const Json& node,
                       const std::string& key,
                       std::size_t i,
                       const std::string& at) const {
    const Json& entry = list(node, key, at)[i];
    if (!entry.is_number_integer()) {
      reject(fmt::format("{}.{}[{}]", at, key, i),
             "expected a whole number, found " + entry.dump());
    }
    return entry.get<std::int64_t>();
  }

  /// The numbers of score `i`.
  GateScore score(const Json& node,
                  std::size_t i,
                  const std::string& at,
                  const std::vector<Tolerance>& limits) const {
    GateScore out = requested_scores_[i];
    out.pairs = integer(node, "pairs", i, at);
    out.possible = integer(node, node.contains("possible") ? "possible" : "pairs", i, at);
    out.count = integer(node, node.contains("counts") ? "counts" : "pairs", i, at);
    if (node.contains("statuses")) {
      const Json& status = list(node, "statuses", at)[i];
      out.status = status_of(status, fmt::format("{}.statuses[{}]", at, i));
    }
    if (!has_numbers(out.status)) return out;
    for (const Tolerance& limit : limits) {
      for (const std::string& statistic : limit.values) {
        const Json& entry = list(node, statistic, at)[i];
        if (!entry.is_number()) {
          reject(fmt::format("{}.{}[{}]", at, statistic, i),
                 "expected a number, found " + entry.dump());
        }
        out.values[statistic] = entry.get<double>();
      }
    }
    return out;
  }

  GateCell cell(const Json& node,
                const std::string& at,
                const std::vector<Tolerance>& limits) const {
    GateCell out;
    out.sequence = text(node, "sequence", at);
    out.repeat = static_cast<std::int64_t>(number(node, "repeat", at));
    out.method = text(node, "method", at);
    out.oracle = flag(node, "oracle");
    out.oracle_data = flag(node, "oracle_data");
    out.status = status_of(member(node, "status", at), at + ".status");
    if (!node.contains("pairs")) return out;
    const Json& pairs = list(node, "pairs", at);
    for (std::size_t i = 0; i < requested_scores_.size(); ++i) {
      if (!pairs[i].is_null()) out.scores.push_back(score(node, i, at, limits));
    }
    return out;
  }

  std::string file_;
  std::vector<GateScore> requested_scores_;
};

}  // namespace

namespace {

/// The reason in "[json.exception...] parse error at ...: the reason".
std::string reason_of(const Json::exception& error) {
  const std::string what = error.what();
  const std::size_t reason = what.find(": ");
  return reason == std::string::npos ? what : what.substr(reason + 2);
}

Json parsed(const std::string& text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = static_cast<std::size_t>(1 + std::count(text.begin(), end, '\n'));
    throw input_error(file, line, "is not JSON: " + reason_of(error));
  } catch (const Json::exception& error) {  // such as a number beyond the largest double
    throw InputError(file + ": is not a baseline: " + reason_of(error));
  }
}

std::string baseline_text(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = std::size_t{1} << 30;  // [bytes]
  return read_named_file(file, kLargest, "a baseline (--update writes one)");
}

}  // namespace

Baseline parse_baseline(const std::string& text, const std::string& file) {
  const Json root = parsed(text, file);
  Baseline out = BaselineReader(file).read(root);
  const std::string digest = digest_of(text);
  const auto found = root.find("digest");
  if (found != root.end() && *found == digest) return out;
  throw InputError(
      fmt::format("{}: digest: found {}, expected \"{}\": the file was changed since "
                  "it was written, and not only its limits; restore it, or check the "
                  "results and write it again with --update",
                  file,
                  found == root.end() ? "none" : found->dump(),
                  digest));
}

Baseline read_baseline(const std::filesystem::path& file) {
  return parse_baseline(baseline_text(file), file.string());
}

std::vector<Tolerance> read_limits(const std::filesystem::path& file) {
  return BaselineReader(file.string()).limits(parsed(baseline_text(file), file.string()));
}

}  // namespace loopbench::harness
