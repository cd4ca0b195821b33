#include "harness/commands/eval/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "datasets/bags/bag_trajectory.hpp"
#include "harness/commands/files/transformation.hpp"
#include "harness/sweep/config/choices.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/pairing/select_pairs.hpp"

namespace loopbench::harness {
namespace {

/// -s adds a scale to the alignment; without --align it estimates only the scale, as in evo.
std::string scaled(const std::string& align) {
  if (align == "none") return "scale";
  if (align == "se3" || align == "sim3") return "sim3";
  throw OptionError("align", "align = " + align + ": has no variant with scale; use se3 or none");
}

Params changes(const EvalArguments& a, const metrics::Protocol& base) {
  Params out = parse_settings(a.settings, describe(base));
  if (a.correct_scale) {
    const auto given = out.find("align");
    out["align"] = scaled(given == out.end() ? to_text(base.align) : to_text(given->second));
  }
  return out;
}

bool has_frames(const std::string& folder) {
  try {
    return detect_format(folder) == Format::frames;
  } catch (const InputError&) {
    return false;
  }
}

/// Rejects a folder where a file is expected, unless it has one file per frame.
void reject_folder(const std::string& estimate, const EvalArguments& a) {
  if (names_bag(estimate) || !std::filesystem::is_directory(estimate)) return;
  if (has_frames(estimate)) return;
  const std::string folder = (std::filesystem::path(estimate) / "").lexically_normal().string();
  throw InputError(estimate + ": is a folder, expected trajectory files, for example `eval " +
                   a.reference + " " + folder + "*.txt`");
}

/// Maps evo's words for relations and units to ours.
std::string our_word(const std::string& word) {
  const std::map<std::string, std::string> evo{{"full", "full_transformation"},
                                               {"trans_part", "translation_part"},
                                               {"rot_part", "rotation_part"},
                                               {"angle_deg", "rotation_angle_deg"},
                                               {"angle_rad", "rotation_angle_rad"},
                                               {"f", "frames"},
                                               {"d", "deg"},
                                               {"r", "rad"}};
  const auto found = evo.find(word);
  return found == evo.end() ? word : found->second;
}

std::string options_text(const Params& options) {
  std::string out;
  for (const auto& [name, value] : options) out += " " + name + "=" + to_text(value);
  return out;
}

/// "rpe 1 s": a metric and its options as the heading of a column.
std::string heading(const std::string& metric, Params options) {
  for (const char* in_heading : {"relation", "each"}) options.erase(in_heading);
  const auto delta = options.find("delta");
  const auto unit = options.find("unit");
  if (delta == options.end() || unit == options.end()) return metric + options_text(options);
  const double* real = std::get_if<double>(&delta->second);
  const std::string number = real ? fmt::format("{}", *real) : to_text(delta->second);
  const std::string out = metric + " " + number + " " + to_text(unit->second);
  options.erase("delta");
  options.erase("unit");
  return out + options_text(options);
}

/// Adds a metric; of two with one heading, the one without options remains.
void add_metric(std::vector<MetricChoice>& out, const std::string& name, const Params& options) {
  const std::string label = heading(name, options);
  const auto known = std::ranges::find(out, label, &MetricChoice::label);
  if (known == out.end()) {
    out.push_back({label, {name, options}});
  } else if (options.empty()) {
    known->metric.options.clear();
  }
}

void add_defaults(std::vector<MetricChoice>& out, const metrics::Protocol& protocol) {
  add_metric(out, "ate", {});
  add_metric(out, "axis_error", {});
  if (protocol.pairs == metrics::PairRule::tum_random) {
    add_metric(out, "rpe", {});
  } else {
    for (const char* unit : {"frames", "s", "m"}) {
      add_metric(out, "rpe", {{"delta", 1.0}, {"unit", std::string(unit)}});
    }
  }
  const bool is_at_reference = protocol.association == metrics::Association::interpolate_estimate;
  if (is_at_reference) add_metric(out, "control_points", {});
  const bool has_lengths = protocol.segments != metrics::SegmentErrorRule{};
  add_metric(out, "segments", has_lengths ? Params{} : Params{{"each", false}});
}

std::vector<MetricChoice> metrics_of_evo(const EvalArguments& a) {
  metrics::Relation relation = metrics::Relation::usual;
  if (!a.relation.empty()) {
    FieldType<metrics::Relation>::assign("pose_relation", relation, our_word(a.relation));
  }
  metrics::DeltaUnit unit = metrics::DeltaUnit::frames;
  if (!a.delta_unit.empty()) {
    FieldType<metrics::DeltaUnit>::assign("delta_unit", unit, our_word(a.delta_unit));
  }
  Params motion{{"delta", a.delta.value_or(1.0)}, {"unit", to_text(unit)}};
  std::vector<MetricChoice> out;
  if (relation != metrics::Relation::usual) {
    motion["relation"] = to_text(relation);
    // point_distance_error_ratio is defined only for relative errors.
    if (relation != metrics::Relation::point_distance_error_ratio) {
      add_metric(out, "ape", {{"relation", to_text(relation)}});
    }
  }
  add_metric(out, "rpe", motion);
  return out;
}

}  // namespace

std::vector<metrics::NamedProtocol> protocols(const EvalArguments& a) {
  std::vector<metrics::NamedProtocol> out;
  for (const std::string& name : a.protocols) {
    out.push_back(known_protocol(name, changes(a, known_protocol(name, {}).rules)));
    const std::string label = out.back().label();
    if (std::ranges::count(out, label, &metrics::NamedProtocol::label) > 1) {
      throw InputError("--protocol: '" + label + "' is listed twice");
    }
  }
  return out;
}

std::vector<MetricChoice> metric_choices(const EvalArguments& a,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols) {
  std::vector<MetricChoice> out;
  for (const std::string& text : a.metrics) {
    const Choice metric =
        metric_choices(parse_entry(text, "--metric"), catalogue, protocols).front().metric;
    add_metric(out, metric.name, metric.options);
  }
  if (!out.empty()) return out;
  if (!a.relation.empty() || a.delta || !a.delta_unit.empty()) return metrics_of_evo(a);
  for (const metrics::NamedProtocol& protocol : protocols) add_defaults(out, protocol.rules);
  return out;
}

EvaluatedRange evaluated_range(const EvalArguments& a) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  const EvaluatedRange out{a.start.value_or(-kForever), a.end.value_or(kForever)};
  if (out.start <= out.end) return out;
  throw InputError(fmt::format("--start {} is after --end {}", out.start, out.end));
}

ReferenceBody reference_body(const EvalArguments& a) {
  ReferenceBody out;
  if (!a.reference_body) return out;
  const auto error = [&](const std::string& what) {
    return InputError("--ref-body: '" + *a.reference_body + "'" + what);
  };
  const std::vector<double> given = comma_separated_numbers(*a.reference_body);
  constexpr double kMost = 1e6;  // as in the dataset option
  const bool is_too_large =
      std::ranges::any_of(given, [](double each) { return std::abs(each) > kMost; });
  if (is_too_large || (given.size() != 3 && given.size() != 7)) {
    throw error(": expected x,y,z [m] or x,y,z,qx,qy,qz,qw, for example 0.05,0,-0.1");
  }
  double* const members[] = {&out.x, &out.y, &out.z, &out.qx, &out.qy, &out.qz, &out.qw};
  for (std::size_t i = 0; i < given.size(); ++i) *members[i] = given[i];
  try {
    pose_of(out);
  } catch (const OptionError&) {
    throw error(": expected a unit quaternion after the position");
  }
  return out;
}

void check_estimates(const EvalArguments& a) {
  if (!a.covariances.empty() && a.estimates.size() != 1) {
    throw InputError("--cov " + a.covariances + ": expected one EST");
  }
  for (const std::string& estimate : a.estimates) reject_folder(estimate, a);
}

}  // namespace loopbench::harness
