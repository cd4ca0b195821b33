#include "harness/report/store_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostRowsOfFigures =
    800;  // of a curve, without its peaks; more are not visible

Vector3 origin_of(const std::optional<SequenceTrace>& trace) {
  if (!trace) return Vector3::Zero();
  return {trace->origin.x, trace->origin.y, trace->origin.z};
}

void add_position(DrawnCurve& curve, const Vector3& position) {
  curve.columns["x"].push_back(position.x());
  curve.columns["y"].push_back(position.y());
  curve.columns["z"].push_back(position.z());
}

DrawnCurve curve_of(const SequenceTrace& trace) {
  DrawnCurve out = reference_curve();
  for (const TracePose& p : trace.reference) {
    add_position(out, origin_of(trace) + Vector3(p.x, p.y, p.z));
  }
  thin(out, kMostRowsOfFigures);
  return out;
}

/// Distances are along the path of the reference.
DrawnCurve curve_of(const CellTrace& trace, const Vector3& origin) {
  DrawnCurve out;
  std::vector<double>& distance = out.columns["distance"];
  Vector3 before = Vector3::Zero();
  for (const TraceSample& s : trace.samples) {
    const Vector3 position(s.estimate.x, s.estimate.y, s.estimate.z);
    const Vector3 expected = position - Vector3(s.error_x, s.error_y, s.error_z);
    distance.push_back(distance.empty() ? 0.0 : distance.back() + (expected - before).norm());
    before = expected;
    add_position(out, origin + position);
    out.columns["error_x"].push_back(s.error_x);
    out.columns["error_y"].push_back(s.error_y);
    out.columns["error_z"].push_back(s.error_z);
    out.columns["angle"].push_back(s.error_angle);
  }
  thin(out, kMostRowsOfFigures, {"error_x", "error_y", "error_z", "angle"});
  return out;
}

}  // namespace

const std::vector<std::string>& panel_names() {
  static const std::vector<std::string> names{
      "plane", "xy", "xz", "yz", "xyz", "x", "y", "z", "angle"};
  return names;
}

std::vector<std::string> figure_panels(const std::vector<std::string>& names, bool of_errors) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    const bool is_error = name.size() == 1 || name == "angle";
    if (is_error != of_errors) continue;
    out.push_back(!is_error         ? name
                  : name == "angle" ? "angle by distance"
                                    : "error_" + name + " by distance");
  }
  return out;
}

FigureData sequence_figure_data(const std::vector<CellRecord>& cells,
                                Traces& traces,
                                const std::string& sequence,
                                const std::vector<std::string>& methods,
                                const std::vector<std::string>& all_methods) {
  std::set<std::int64_t> repeats;
  for (const CellRecord& cell : cells) {
    if (cell.sequence == sequence) repeats.insert(cell.repeat);
  }
  FigureData out{sequence, "", {}, {}};
  if (repeats.empty()) return out;
  const std::int64_t first = *repeats.begin();
  if (repeats.size() > 1) {
    out.title += fmt::format(", repeat {} (first of {})", first, repeats.size());
  }
  Vector3 origin = Vector3::Zero();
  for (const std::string& method : methods) {
    const auto cell = std::ranges::find_if(cells, [&](const CellRecord& c) {
      return c.sequence == sequence && c.repeat == first && c.method == method;
    });
    if (cell == cells.end()) continue;
    const std::optional<CellTrace> trace = traces.cell(cell->position);
    if (!trace || trace->samples.empty()) continue;
    if (out.curves.empty()) {
      const std::optional<SequenceTrace> reference = traces.sequence(cell->position);
      if (reference) out.curves.push_back(curve_of(*reference));
      origin = origin_of(reference);
    }
    DrawnCurve& curve = out.curves.emplace_back(curve_of(*trace, origin));
    const auto index = std::ranges::find(all_methods, method) - all_methods.begin();
    curve.name = method;
    curve.style = static_cast<std::size_t>(index);
  }
  return out;
}

std::string file_stem(const std::string& label) {
  std::string out;
  for (const char c : label) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (is_plain) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.substr(0, 80);
}

}  // namespace loopbench::harness
