#include "harness/sweep/config/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "harness/sweep/config/values.hpp"

namespace loopbench::harness {
namespace {

/// Far above real sweeps: a few lines can request more than fits into memory.
constexpr std::size_t kMostPoints = 10'000;

using Axis = std::vector<std::vector<Setting>>;  // one inner list per step along the axis

void flatten(const YamlNode& node, const std::string& name, std::vector<Setting>& out) {
  if (node.type == YamlNode::Type::list) {
    throw node.error(name + ": lists are accepted only under 'sweep' or 'zip'");
  }
  if (node.type == YamlNode::Type::scalar) out.push_back({name, node.scalar, node, node.text});
  if (node.type != YamlNode::Type::scalar && node.map.empty()) {
    throw node.error(name + ": has no value");
  }
  for (const auto& [key, value] : node.map) flatten(value, name + "." + key, out);
}

/// Rounded to 15 digits, because every label shows the values: 0.1 to 0.5 in five steps contains
/// 0.3, not 0.30000000000000004.
double rounded(double value) {
  if (value == std::round(value)) return value;
  return std::strtod(fmt::format("{:.15g}", value).c_str(), nullptr);
}

/// The numbers of {from, to, steps, log}.
std::vector<Param> range(const YamlNode& node) {
  for (const auto& [key, value] : node.map) {
    if (key != "from" && key != "to" && key != "steps" && key != "log") {
      throw value.error(key + ": unknown key of a range (from, to, steps, log)");
    }
  }
  for (const char* key : {"from", "to", "steps"}) {
    if (node.find(key) != nullptr) continue;
    throw node.error(fmt::format("a range needs from, to and steps; '{}' is missing", key));
  }
  const double from = as_number(*node.find("from"), "from");
  const double to = as_number(*node.find("to"), "to");
  const std::int64_t steps = as_integer(*node.find("steps"), "steps", 100'000);
  bool is_log = false;
  read_key(node, "log", is_log, as_flag);
  if (is_log && !(from > 0.0 && to > 0.0)) {
    throw node.error("a range with log: true needs from > 0 and to > 0");
  }
  std::vector<double> points;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double u = steps == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(steps - 1);
    const bool is_end = i > 0 && i + 1 == steps;  // the end is exact
    const double between = is_log ? from * std::pow(to / from, u) : from + u * (to - from);
    points.push_back(is_end ? to : rounded(between));
    if (i == 0) points.back() = from;
  }
  if (!std::ranges::all_of(points, [](double p) { return std::isfinite(p); })) {
    throw node.error("the range from .. to is too wide for double precision");
  }
  constexpr double kExact = 9007199254740992.0;  // 2^53: larger integers are not all representable
  const bool is_integer =
      !is_log && std::holds_alternative<std::int64_t>(node.find("from")->scalar) &&
      std::ranges::all_of(points,
                          [](double p) { return p == std::round(p) && std::abs(p) <= kExact; });
  std::vector<Param> out;
  for (const double point : points) {
    out.push_back(is_integer ? Param(static_cast<std::int64_t>(point)) : Param(point));
  }
  return out;
}

std::vector<Setting> values(const YamlNode& node, const std::string& name) {
  std::vector<Setting> out;
  if (node.type == YamlNode::Type::map) {
    for (const Param& value : range(node)) out.push_back({name, value, node});
    return out;
  }
  if (node.type != YamlNode::Type::list || node.list.empty()) {
    throw node.error(name + ": expected a list or {from, to, steps}");
  }
  for (const YamlNode& item : node.list) {
    if (item.type != YamlNode::Type::scalar) {
      throw item.error(name + ": expected scalar values in the list");
    }
    out.push_back({name, item.scalar, node, item.text});
  }
  return out;
}

void expect_few_points(std::size_t count, const Place& place) {
  if (count <= kMostPoints) return;
  throw place.error(fmt::format("sweeps over more than {} combinations", kMostPoints));
}

Axis zipped(const YamlNode& zip) {
  Axis axis;
  for (const auto& [name, node] : zip.map) {
    const std::vector<Setting> column = values(node, name);
    expect_few_points(column.size(), zip);
    if (axis.empty()) axis.resize(column.size());
    if (axis.size() != column.size()) {
      throw node.error(fmt::format(
          "{}: has {} values, the others under 'zip' have {}", name, column.size(), axis.size()));
    }
    for (std::size_t i = 0; i < column.size(); ++i) axis[i].push_back(column[i]);
  }
  return axis;
}

/// Each point with each step of the axis.
std::vector<GridPoint> product(const std::vector<GridPoint>& points, const Axis& axis) {
  std::vector<GridPoint> out;
  for (const GridPoint& point : points) {
    for (const std::vector<Setting>& step : axis) {
      GridPoint& next = out.emplace_back(point);
      for (const Setting& setting : step) {
        next.settings.push_back(setting);
        next.swept.push_back(setting.name);
      }
    }
  }
  return out;
}

}  // namespace

void reject_repeats(const GridPoint& point) {
  std::set<std::string> seen;
  for (const Setting& setting : point.settings) {
    if (seen.insert(setting.name).second) continue;
    throw setting.place.error(setting.name + ": is set twice in this entry");
  }
}

std::vector<GridPoint> expand(const YamlNode& entry, const std::vector<std::string>& reserved) {
  std::vector<GridPoint> points(1);
  for (const auto& [key, node] : entry.map) {
    if (key == "sweep" || key == "zip" || std::ranges::count(reserved, key) > 0) continue;
    flatten(node, key, points.front().settings);
  }
  if (const YamlNode* sweep = entry.find("sweep")) {
    require_map(*sweep, "sweep", "a map from option to values");
    for (const auto& [name, node] : sweep->map) {
      Axis axis;
      for (const Setting& value : values(node, name)) axis.push_back({value});
      expect_few_points(points.size() * axis.size(), entry);
      points = product(points, axis);
    }
  }
  if (const YamlNode* zip = entry.find("zip")) {
    require_map(*zip, "zip", "a map from option to values");
    const Axis axis = zipped(*zip);
    expect_few_points(points.size() * axis.size(), entry);
    points = product(points, axis);
  }
  for (const GridPoint& point : points) reject_repeats(point);
  return points;
}

}  // namespace loopbench::harness
