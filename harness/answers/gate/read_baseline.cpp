#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/compressed/input_file.hpp"
#include "datasets/core/error.hpp"
#include "datasets/core/fields.hpp"
#include "harness/answers/gate/baseline.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

/// A limit, which users edit; `at` is its place in the file. Throws InputError.
Tolerance limit_of(const Json& node, const std::string& at) {
  if (!node.is_object()) throw InputError(at + ": expected an object");
  // A misspelt key would be a limit that is not applied.
  static const std::vector<std::string> known{"where", "values", "relative", "absolute"};
  for (const auto& entry : node.items()) {
    if (std::ranges::count(known, entry.key()) > 0) continue;
    throw InputError(at + ": " + unknown_name("key of a limit", entry.key(), known));
  }
  const auto member = [&](const char* key, const char* expected, auto is_valid) -> const Json& {
    const auto found = node.find(key);
    if (found != node.end() && is_valid(*found)) return *found;
    throw InputError(fmt::format("{}.{}: expected {}, found {}",
                                 at,
                                 key,
                                 expected,
                                 found == node.end() ? "none" : found->dump()));
  };
  const auto number = [&](const char* key) {
    return member(key,
                  "a non-negative number",
                  [](const Json& n) { return n.is_number() && n.get<double>() >= 0.0; })
        .get<double>();
  };
  const auto texts = [&](const char* key) {
    return member(key,
                  "a list of texts",
                  [](const Json& n) {
                    return n.is_array() && std::ranges::all_of(n, &Json::is_string);
                  })
        .get<std::vector<std::string>>();
  };
  Tolerance out{texts("where"), texts("values"), number("relative"), number("absolute")};
  if (out.values.empty()) throw InputError(at + ".values: expected at least one statistic");
  try {
    where(out.where);
    for (const std::string& statistic : out.values) value(Record{}, statistic);
  } catch (const InputError& error) {
    throw InputError(at + ": " + error.what());
  }
  return out;
}

std::vector<Tolerance> limits_of(const Json& root, const std::string& file) {
  std::vector<Tolerance> out;
  for (const Json& entry : root.at("limits")) {
    out.push_back(limit_of(entry, fmt::format("{}: limits[{}]", file, out.size())));
  }
  return out;
}

template <class T>
T known(const Json& node) {
  const auto found = from_text<T>(node.get<std::string>());
  if (!found) throw InputError("expected " + choice_list<T>() + ", found " + node.dump());
  return *found;
}

ScoreKind kind_of(const Json& node) {
  ScoreKind out;
  for (const KindField& each : kKindFields) node.at(each.name).get_to(out.*each.text);
  out.better = known<metrics::Better>(node.at("better"));
  out.target = node.value("target", 0.0);
  return out;
}

/// [5, 5, 7] of [[5, 2], [7, 1]]; `size`: of the result.
std::vector<Json> unpacked(const Json& node, std::size_t size) {
  std::vector<Json> out;
  for (const Json& entry : node) {
    const auto count = entry.at(1).get<std::size_t>();
    out.insert(out.end(), std::min(count, size - out.size()), entry.at(0));
  }
  if (out.size() == size) return out;
  throw InputError(fmt::format("expected {} values, found {}", size, node.dump()));
}

/// Appends the records of a cell, one for each of `kinds` that it has.
void add_cell(std::vector<Record>& out,
              const Json& node,
              const std::vector<Shared<ScoreKind>>& kinds,
              const std::vector<std::string>& statistics) {
  Record first;
  CellRow& cell = first.cell.edit();
  cell.sequence = node.at("sequence").get<std::string>();
  cell.repeat = node.at("repeat").get<std::int64_t>();
  cell.method = node.at("method").get<std::string>();
  cell.oracle = node.value("oracle", false);
  cell.oracle_closures = node.value("oracle_data", false);
  first.status = known<Status>(node.at("status"));
  if (!node.contains("pairs")) {
    out.push_back(first);
    return;
  }
  const auto list = [&](const char* key) {
    return unpacked(node.at(node.contains(key) ? key : "pairs"), kinds.size());
  };
  const std::vector<Json> pairs = list("pairs"), possible = list("possible"),
                          counts = list("counts"), statuses = list("statuses");
  const bool has_statuses = node.contains("statuses");
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (pairs[i].is_null()) continue;
    Record& score = out.emplace_back(first);
    score.kind = kinds[i];
    score.pairs = pairs[i].get<std::int64_t>();
    score.possible = possible[i].get<std::int64_t>();
    score.status = has_statuses ? known<Status>(statuses[i]) : Status::ok;
    score.statistics.count = counts[i].get<std::size_t>();
    if (!has_numbers(score.status)) continue;
    for (const std::string& statistic : statistics) {
      if (statistic == "count") continue;
      const Json& number = node.at(statistic).at(i);
      score.statistics.*member_of(statistic) =
          number.is_null() ? std::nan("") : number.get<double>();
    }
  }
}

/// A limit that is set tighter than the numbers are written would see their rounding.
void require_seen(const std::vector<Tolerance>& limits,
                  const Rounding& precision,
                  const std::string& file) {
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const Tolerance& limit = limits[i];
    if (limit.relative >= 10.0 * precision.relative && limit.absolute >= 10.0 * precision.absolute)
      continue;
    throw InputError(
        fmt::format("{}: limits[{}]: is too tight for the numbers of the file, which are rounded "
                    "to relative {:g}, absolute {:g}; write it again with --update (limits are "
                    "kept)",
                    file,
                    i,
                    precision.relative,
                    precision.absolute));
  }
}

Baseline baseline_of(const Json& root, const std::string& file) {
  Baseline out;
  out.limits = limits_of(root, file);
  root.at("build_summary").get_to(out.build_summary);
  Snapshot& snapshot = out.snapshot;
  root.at("sweep").get_to(snapshot.sweep);
  root.at("machine").get_to(snapshot.machine);
  for (const DefinitionKind& each : kDefinitions) root.at(each.name).get_to(snapshot.*each.member);
  const Json& precision = root.at("precision");
  require_seen(out.limits,
               {precision.at("relative").get<double>(), precision.at("absolute").get<double>()},
               file);
  std::vector<Shared<ScoreKind>> kinds;
  for (const Json& entry : root.at("scores")) kinds.emplace_back(kind_of(entry));
  const std::vector<std::string> statistics = compared_statistics(out.limits);
  for (const Json& entry : root.at("cells")) {
    for (const std::string& statistic : statistics) {
      if (statistic == "count" || !entry.contains("pairs") || entry.contains(statistic)) continue;
      throw InputError(fmt::format(
          "{}: cells: have no '{}', which a limit names; write it again with --update (limits are "
          "kept)",
          file,
          statistic));
    }
    add_cell(snapshot.records, entry, kinds, statistics);
  }
  return out;
}

/// Runs `read` on the JSON object of the text. Throws InputError with the line of a syntax error.
template <class Read>
auto read_json(const std::string& text, const std::string& file, Read read) {
  const auto reason_of = [](const Json::exception& error) {  // "[json.exception...] at: reason"
    const std::string what = error.what();
    const std::size_t reason = what.find(": ");
    return reason == std::string::npos ? what : what.substr(reason + 2);
  };
  try {
    const Json root = Json::parse(text);
    if (!root.is_object()) throw InputError(file + ": baseline: expected an object");
    return read(root);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = static_cast<std::size_t>(1 + std::count(text.begin(), end, '\n'));
    throw input_error(file, line, "is not JSON: " + reason_of(error));
  } catch (const Json::exception& error) {
    throw InputError(file + ": is not a baseline: " + reason_of(error));
  }
}

std::string baseline_text(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = std::size_t{1} << 30;  // [bytes]
  return read_named_file(file, kLargest, "a baseline (--update writes one)");
}

}  // namespace

Baseline parse_baseline(const std::string& text, const std::string& file) {
  return read_json(text, file, [&](const Json& root) {
    const Json format = root.value("loopbench_baseline", Json());
    if (format != kBaselineFormat) {
      throw InputError(fmt::format(
          "{}: loopbench_baseline: found format {}, expected {}; check the results, then "
          "write it again with check --update (limits are kept)",
          file,
          format.dump(),
          kBaselineFormat));
    }
    const std::string digest = digest_of(text);
    const Json found = root.value("digest", Json());
    if (found == digest) return baseline_of(root, file);
    throw InputError(
        fmt::format("{}: digest: found {}, expected \"{}\": the file was changed since it was "
                    "written, and not only its limits; restore it, or check the results and write "
                    "it again with --update",
                    file,
                    found.is_null() ? "none" : found.dump(),
                    digest));
  });
}

Baseline read_baseline(const std::filesystem::path& file) {
  return parse_baseline(baseline_text(file), file.string());
}

std::vector<Tolerance> read_limits(const std::filesystem::path& file) {
  return read_json(baseline_text(file), file.string(), [&](const Json& root) {
    return limits_of(root, file.string());
  });
}

}  // namespace loopbench::harness
