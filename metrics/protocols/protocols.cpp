#include "metrics/protocols/protocols.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

namespace loopbench::metrics {
namespace {

/// Common to the other tools: any number of pairs gives a relative error, planes have no rule.
Protocol tool() {
  Protocol p;
  p.min_pairs = 1;
  p.planar = Planar::no;
  return p;
}

Protocol evo() {
  Protocol p = tool();
  p.association = Association::evo;
  p.max_diff = 0.01;
  p.align = Align::none;
  p.pairs = PairRule::consecutive;
  p.pairs_from = PairsFrom::estimate;
  return p;
}

Protocol tum() {
  Protocol p = tool();
  p.association = Association::tum;
  p.pairs = PairRule::tum;
  p.pairs_from = PairsFrom::estimate;
  p.form = ErrorForm::tum;
  p.angle = AngleFormula::trace;
  return p;
}

Protocol rpg() {
  Protocol p = tool();
  p.association = Association::tum;
  p.align = Align::sim3;
  p.angle = AngleFormula::trace;
  p.segments.end = SegmentEnd::rpg;
  p.segments.fewest = 2;
  p.segments.up = PairsFrom::estimate;
  return p;
}

Protocol rpg_fixed() {
  Protocol p = rpg();
  p.segments.end = SegmentEnd::nearest;
  return p;
}

Protocol kitti() {
  Protocol p = tool();
  p.association = Association::index;
  p.align = Align::none;
  p.form = ErrorForm::kitti;
  p.angle = AngleFormula::trace;
  p.segments = {.lengths = "100 200 300 400 500 600 700 800",
                .tolerance = "0",
                .end = SegmentEnd::beyond,
                .step = 10,
                .precision = Precision::float32};
  p.statistic = Statistic::mean;
  return p;
}

Protocol kitti_double() {
  Protocol p = kitti();
  p.segments.precision = Precision::float64;
  return p;
}

Protocol hilti() {
  Protocol p = tool();
  p.association = Association::interpolate_estimate;
  return p;
}

/// Rejects fields that the chosen association ignores.
void check_used(const Protocol& rules, const Params& changes) {
  const Association how = rules.association;
  const bool has_gap = interpolates(how);
  const bool has_difference = !has_gap && how != Association::index;
  for (const auto& [field, is_used] :
       {std::pair{"max_diff", has_difference}, std::pair{"max_gap", has_gap}}) {
    const auto given = changes.find(field);
    if (given == changes.end() || is_used) continue;
    throw OptionError(field,
                      std::string(field) + " = " + to_text(given->second) + ": association " +
                          to_text(how) + " does not use it");
  }
}

}  // namespace

std::vector<ProtocolEntry> protocols() {
  return {
      {"loopbench",
       "4",
       "our default: one-to-one nearest stamps in order, SE(3), pairs selected on the reference",
       Protocol{}},
      {"evo",
       "26d0953",
       "evo_ape, evo_rpe: 10 ms, a pose can be paired twice; papers mostly add align: se3 or sim3",
       evo()},
      {"tum",
       "evo 26d0953, test/tum_benchmark_tools",
       "TUM RGB-D: evaluate_ate.py, evaluate_rpe.py --fixed_delta (without it: pairs: tum_random)",
       tum()},
      {"rpg",
       "8c8ceec",
       "rpg_trajectory_evaluation as released (VIO): Sim(3), sub-trajectories with shifted ends",
       rpg()},
      {"rpg-fixed",
       "8c8ceec",
       "rpg with the end of each sub-trajectory at its own start",
       rpg_fixed()},
      {"kitti",
       "2afdb93",
       "KITTI odometry leaderboard and devkit: all poses, 100..800 m, % and deg/m, float32",
       kitti()},
      {"kitti-double",
       "2afdb93",
       "the devkit's rules in double precision, as in Python reimplementations",
       kitti_double()},
      {"hilti",
       "challenge 2023",
       "control points: estimate interpolated at the points' stamps, SE(3); metric control_points",
       hilti()},
  };
}

std::string NamedProtocol::label() const {
  return changes.empty() ? name : name + " (" + to_text(changes) + ")";
}

NamedProtocol named_protocol(const std::string& name, const Params& changes) {
  const std::vector<ProtocolEntry> known = protocols();
  const auto found = std::ranges::find(known, name, &ProtocolEntry::name);
  if (found == known.end()) {
    std::string names;
    for (const ProtocolEntry& entry : known) names += (names.empty() ? "" : ", ") + entry.name;
    throw InputError("no protocol is named '" + name + "' (known: " + names + ")");
  }
  NamedProtocol out{found->name, found->version, {}, with(found->protocol, changes)};
  check(out.rules);
  check_used(out.rules, changes);
  const Params before = echo(found->protocol);
  for (auto& [field, value] : echo(out.rules)) {
    if (before.at(field) != value) out.changes.emplace(field, value);
  }
  return out;
}

}  // namespace loopbench::metrics
