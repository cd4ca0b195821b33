#include "harness/config/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// Limits far above real sweeps: a few lines can request more than fits into memory.
constexpr std::size_t kMostPoints = 10'000;
constexpr std::size_t kMostSettings = 200;  // per grid point

using Axis = std::vector<std::vector<Setting>>;  // one inner list per step along the axis

void flatten(const YamlNode& node,
             const std::string& name,
             const std::string& file,
             std::vector<Setting>& out) {
  switch (node.type) {
    case YamlNode::Type::scalar:
      out.push_back({name, node.scalar, node.line, node.text});
      break;
    case YamlNode::Type::map:
      if (node.map.empty()) throw input_error(file, node.line, name + ": has no value");
      for (const auto& [key, value] : node.map) flatten(value, name + "." + key, file, out);
      break;
    case YamlNode::Type::list:
      throw input_error(file, node.line, name + ": lists are accepted only under 'sweep' or 'zip'");
    case YamlNode::Type::null:
      throw input_error(file, node.line, name + ": has no value");
  }
}

std::vector<Setting> values(const YamlNode& node,
                            const std::string& name,
                            const std::string& file) {
  std::vector<Setting> out;
  if (node.type == YamlNode::Type::map) {
    for (const Param& value : range(node, file)) out.push_back({name, value, node.line});
    return out;
  }
  if (node.type != YamlNode::Type::list || node.list.empty()) {
    throw input_error(file, node.line, name + ": expected a list or {from, to, steps}");
  }
  for (const YamlNode& item : node.list) {
    if (item.type != YamlNode::Type::scalar) {
      throw input_error(file, item.line, name + ": expected scalar values in the list");
    }
    out.push_back({name, item.scalar, node.line, item.text});
  }
  return out;
}

const YamlNode& as_map(const YamlNode& node, const std::string& name, const std::string& file) {
  if (node.type == YamlNode::Type::map) return node;
  throw input_error(file, node.line, "'" + name + "' must be a map from option to values");
}

double number(const YamlNode& node, const std::string& name, const std::string& file) {
  if (node.type == YamlNode::Type::scalar) {
    if (const auto* integer = std::get_if<std::int64_t>(&node.scalar)) {
      return static_cast<double>(*integer);
    }
    if (const auto* real = std::get_if<double>(&node.scalar); real && std::isfinite(*real)) {
      return *real;
    }
  }
  throw input_error(file, node.line, name + ": expected a number");
}

void expect_few_points(std::size_t count, std::size_t line, const std::string& file) {
  if (count <= kMostPoints) return;
  throw input_error(
      file, line, "sweeps over more than " + std::to_string(kMostPoints) + " combinations");
}

/// Checks the number of options set in one entry, swept or not.
void expect_few_settings(const YamlNode& entry, std::size_t fixed, const std::string& file) {
  std::size_t count = fixed;
  for (const char* key : {"sweep", "zip"}) {
    if (const YamlNode* node = entry.find(key)) count += node->map.size();
  }
  if (count <= kMostSettings) return;
  throw input_error(file,
                    entry.line,
                    "sets " + std::to_string(count) + " options, expected at most " +
                        std::to_string(kMostSettings));
}

Axis zipped(const YamlNode& zip, const std::string& file) {
  Axis axis;
  for (const auto& [name, node] : as_map(zip, "zip", file).map) {
    const std::vector<Setting> column = values(node, name, file);
    expect_few_points(column.size(), zip.line, file);
    if (axis.empty()) axis.resize(column.size());
    if (axis.size() != column.size()) {
      throw input_error(file,
                        node.line,
                        name + ": has " + std::to_string(column.size()) +
                            " values, the others under 'zip' have " + std::to_string(axis.size()));
    }
    for (std::size_t i = 0; i < column.size(); ++i) axis[i].push_back(column[i]);
  }
  return axis;
}

void refuse_repeats(const GridPoint& point, const std::string& file) {
  std::set<std::string> seen;
  for (const Setting& setting : point.settings) {
    if (!seen.insert(setting.name).second) {
      throw input_error(file, setting.line, setting.name + ": is set twice in this entry");
    }
  }
}

}  // namespace

std::vector<Param> range(const YamlNode& node, const std::string& file) {
  for (const auto& [key, value] : node.map) {
    if (key != "from" && key != "to" && key != "steps" && key != "log") {
      throw input_error(file, value.line, key + ": unknown key of a range (from, to, steps, log)");
    }
  }
  const auto need = [&](const std::string& key) -> const YamlNode& {
    if (const YamlNode* found = node.find(key)) return *found;
    throw input_error(
        file, node.line, "a range needs from, to and steps; '" + key + "' is missing");
  };
  const double from = number(need("from"), "from", file);
  const double to = number(need("to"), "to", file);
  const auto* steps = std::get_if<std::int64_t>(&need("steps").scalar);
  if (steps == nullptr || *steps < 1 || *steps > 100000) {
    throw input_error(file, need("steps").line, "steps: expected a whole number, 1 to 100000");
  }
  const YamlNode* log = node.find("log");
  if (log != nullptr &&
      (log->type != YamlNode::Type::scalar || !std::holds_alternative<bool>(log->scalar))) {
    throw input_error(file, log->line, "log: expected true or false");
  }
  const bool is_log = log != nullptr && std::get<bool>(log->scalar);
  if (is_log && !(from > 0.0 && to > 0.0)) {
    throw input_error(file, node.line, "a range with log: true needs from > 0 and to > 0");
  }

  // 0.1 to 0.5 in five steps contains 0.3, not 0.30000000000000004: round to 15 digits, because
  // every label shows the values.
  const auto rounded = [](double value) {
    if (value == std::round(value)) return value;
    std::array<char, 32> digits;
    std::snprintf(digits.data(), digits.size(), "%.15g", value);
    return std::strtod(digits.data(), nullptr);
  };
  std::vector<double> points;
  for (std::int64_t i = 0; i < *steps; ++i) {
    const double u = *steps == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(*steps - 1);
    const bool is_end = i > 0 && i + 1 == *steps;  // the end is exact
    const double between = is_log ? from * std::pow(to / from, u) : from + u * (to - from);
    points.push_back(i == 0 ? from : is_end ? to : rounded(between));
  }
  if (!std::ranges::all_of(points, [](double p) { return std::isfinite(p); })) {
    throw input_error(file, node.line, "the range from .. to is too wide for double precision");
  }
  constexpr double kExact = 9007199254740992.0;  // 2^53: larger integers are not all representable
  const bool integer = !is_log && std::holds_alternative<std::int64_t>(need("from").scalar) &&
                       std::ranges::all_of(points, [](double p) {
                         return p == std::round(p) && std::abs(p) <= kExact;
                       });
  std::vector<Param> out;
  for (const double point : points) {
    out.push_back(integer ? Param(static_cast<std::int64_t>(point)) : Param(point));
  }
  return out;
}

std::vector<GridPoint> expand(const YamlNode& entry,
                              const std::vector<std::string>& reserved,
                              const std::string& file) {
  std::vector<GridPoint> points(1);
  for (const auto& [key, node] : entry.map) {
    if (key == "sweep" || key == "zip" || std::ranges::count(reserved, key) > 0) continue;
    flatten(node, key, file, points.front().settings);
  }
  expect_few_settings(entry, points.front().settings.size(), file);
  std::vector<Axis> axes;
  std::size_t combinations = 1;
  if (const YamlNode* sweep = entry.find("sweep")) {
    for (const auto& [name, node] : as_map(*sweep, "sweep", file).map) {
      Axis axis;
      for (const Setting& value : values(node, name, file)) axis.push_back({value});
      expect_few_points(combinations *= axis.size(), entry.line, file);
      axes.push_back(std::move(axis));
    }
  }
  if (const YamlNode* zip = entry.find("zip")) {
    axes.push_back(zipped(*zip, file));
    expect_few_points(combinations * axes.back().size(), entry.line, file);
  }
  for (const Axis& axis : axes) {
    std::vector<GridPoint> longer;
    for (const GridPoint& point : points) {
      for (const std::vector<Setting>& step : axis) {
        GridPoint next = point;
        for (const Setting& setting : step) {
          next.settings.push_back(setting);
          next.swept.push_back(setting.name);
        }
        longer.push_back(std::move(next));
      }
    }
    points = std::move(longer);
  }
  for (const GridPoint& point : points) refuse_repeats(point, file);
  return points;
}

}  // namespace loopbench::harness
