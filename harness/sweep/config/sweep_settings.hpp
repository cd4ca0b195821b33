/// Settings of a config beyond its lists of datasets, methods and metrics. The functions throw
/// InputError `file:line:`; `key` is the name of the setting in messages.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "harness/sweep/config/keys.hpp"
#include "harness/sweep/config/values.hpp"
#include "harness/sweep/config/yaml.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/model/where.hpp"

namespace loopbench::harness {

/// Texts that `check` accepts; its InputError gets file and line.
template <class Check>
std::vector<std::string> checked_texts(const YamlNode& node, const std::string& key, Check check) {
  std::vector<std::string> out = as_texts(node, key);
  try {
    check(out);
  } catch (const InputError& error) {
    throw node.error(key + ": " + error.what());
  }
  return out;
}

inline std::vector<metrics::Times> as_times(const YamlNode& node, const std::string& key) {
  std::vector<metrics::Times> out;
  for (const std::string& name : as_texts(node, key)) {
    const auto value = from_text<metrics::Times>(name);
    if (!value) throw node.error("times: expected " + choice_list<metrics::Times>());
    if (std::ranges::count(out, *value) == 0) out.push_back(*value);
  }
  if (out.empty()) throw node.error("times: expected " + choice_list<metrics::Times>());
  return out;
}

/// A number of runs; true for timing cells alone until their CPU time is known to 2 %; or {runs: N,
/// precision: 0.02, serial: true}.
inline void read_timing(const YamlNode& node, Sweep& sweep) {
  constexpr int kMostRuns = 100;  // with a precision
  constexpr double kPrecision = 0.02;
  if (node.type == YamlNode::Type::map) {
    require_keys(node, "timing", config_key_names("timing"));
    const auto share = [](const YamlNode& given, const std::string& key) {
      return as_number(given, key, Between{0.0, 1.0});
    };
    read_key(node, "timing.precision", sweep.precision, share);
    if (sweep.precision > 0.0) sweep.timing = kMostRuns;
    read_key(node, "timing.runs", sweep.timing, as_count);
    read_key(node, "timing.serial", sweep.serial, as_flag);
  } else if (std::holds_alternative<bool>(node.scalar)) {
    sweep.serial = as_flag(node, "timing");
    if (sweep.serial) std::tie(sweep.timing, sweep.precision) = std::pair(kMostRuns, kPrecision);
  } else {
    sweep.timing = as_count(node, "timing");
  }
}

inline Limits as_limits(const YamlNode& node, const std::string& name) {
  require_keys(node, name, config_key_names("limits"));
  Limits out;
  read_key(
      node, "limits.seconds", out.seconds, [](const YamlNode& seconds, const std::string& key) {
        return as_number(seconds, key, Between{0.0});
      });
  read_key(node, "limits.memory", out.memory, as_bytes);
  const auto number = [](const YamlNode& given, const std::string& key) {
    return as_integer(given, key, 1'000'000'000);
  };
  read_key(node, "limits.processes", out.processes, number);
  read_key(node, "limits.cells", out.cells, number);
  return out;
}

/// A list of {dataset: PATTERN, method: PATTERN}.
inline std::vector<Exclusion> as_exclusions(const YamlNode& node, const std::string& name) {
  if (node.type != YamlNode::Type::list) {
    throw node.error("exclude: expected a list of {dataset, method} patterns");
  }
  std::vector<Exclusion> out;
  for (const YamlNode& entry : node.list) {
    require_keys(entry, name, config_key_names("exclude"));
    Exclusion& exclusion = out.emplace_back();
    read_key(entry, "dataset", exclusion.dataset, as_pattern);
    read_key(entry, "method", exclusion.method, as_pattern);
  }
  return out;
}

inline TableSpec as_table(const YamlNode& node, const std::string& name) {
  require_keys(node, name, config_key_names("table"));
  const auto fields = [](const YamlNode& list, const std::string& key) {
    return checked_texts(list, key, [](const auto& names) {
      for (const std::string& each : names) field(Record{}, each);
    });
  };
  const auto statistic = [](const YamlNode& word, const std::string& key) {
    const auto check = [](const auto& names) { value(Record{}, names.front()); };
    return checked_texts(word, key, check).front();
  };
  const auto filters = [](const YamlNode& rules, const std::string& key) {
    return checked_texts(rules, key, [](const auto& all) { where(all); });
  };
  TableSpec out;
  read_key(node, "table.rows", out.rows, fields);
  read_key(node, "table.columns", out.columns, fields);
  read_key(node, "table.split", out.split, fields);
  read_key(node, "table.show", out.show, as_texts);
  read_key(node, "table.value", out.value, statistic);
  read_key(node, "table.plus_minus", out.plus_minus, as_flag);
  read_key(node, "table.where", out.where, filters);
  return out;
}

}  // namespace loopbench::harness
