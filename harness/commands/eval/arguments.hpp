/// Command line arguments of `eval` and their interpretation.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/entry.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Empty strings and optionals mean the protocol's value. Without `repeats` equal stamps are
/// refused, or all are kept if every protocol pairs as evo does.
struct EvalArguments : ReadArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::optional<Format> reference_format;  ///< none: same as `format`
  bool diagnose = true;              ///< likely mistakes in the files, notes and the diagnosis
  bool keeps_failed = false;         ///< an only evaluation that fails is a result with a reason
  double reference_sigma = 0.0;      ///< of its positions, per axis [m]; 0: not stated
  bool reference_positions = false;  ///< ignore the rotations of the reference
  std::optional<std::string> reference_body;  ///< x,y,z[,qx,qy,qz,qw]; none: no offset
  std::string covariances;                    ///< file of the only estimate's; empty: none
  std::string reference_covariances;          ///< file of the reference's; empty: none
  std::optional<std::size_t> downsample;      ///< most poses of each file
  std::vector<double> motion_filter;          ///< thresholds [m, deg] between poses; empty: none
  std::optional<double> start;                ///< time range of the reference [s]; none: all
  std::optional<double> end;
  std::vector<std::string> protocols{"loopbench"};
  std::vector<GivenSetting> settings;  ///< FIELD=VALUE of the protocol
  bool correct_scale = false;
  std::string parts;       ///< `auto` or a file: parts with an alignment each; empty: one
  bool end_error = false;  ///< of loops without a reference: REF is evaluated, too
  std::optional<double> min_coverage;  ///< none: a tenth, and half of the best of another estimate
  std::string relation;
  std::optional<double> delta;
  std::string delta_unit;
  std::vector<std::string> metrics;  ///< NAME[:option=value,...]; empty: the default metrics
  std::vector<std::filesystem::path> plugins;
  std::string unit;   ///< of lengths or angles in the results; empty: m and deg
  bool full = false;  ///< print all scores and the diagnosis
  bool json = false;
  bool csv = false;
  std::string out = "-";       ///< file for what is printed; -: standard output
  std::string per_pose;        ///< output file; empty: none
  bool pose_errors = false;    ///< keep EvaluationResult::poses
  std::string plot;            ///< file of a figure; empty: none
  std::string report;          ///< HTML file; empty: none
  std::string store;           ///< folder of a store for the results; empty: none
  std::string sequence;        ///< label of the reference in the store; empty: from its file name
  std::string group;           ///< recording of the reference; empty: by its geometry
  std::optional<bool> common;  ///< evaluate the times that all estimates cover; none: with a store

  /// Whether trajectories are kept with the results.
  bool keeps_traces() const { return !store.empty() || !report.empty(); }
};

/// Throws InputError for an unknown or repeated protocol or a malformed or repeated setting,
/// OptionError for an invalid one.
std::vector<metrics::NamedProtocol> protocols(const EvalArguments& arguments);

/// The listed metrics. As in evo, a relation selects ape and rpe in that relation; a delta or unit
/// alone selects one rpe. Otherwise ate, axis_error and segments with their defaults (segments for
/// each length if a protocol sets the lengths), and rpe over 1 frame, 1 s and 1 m (once for random
/// pairs); coverage and diagnostics are reported above the table. Throws InputError, OptionError.
std::vector<MetricChoice> metric_choices(const EvalArguments& arguments,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols);

/// Stamps of the reference to evaluate [s]; infinite where the arguments give none.
struct EvaluatedRange {
  double start = 0.0;
  double end = 0.0;
};
EvaluatedRange evaluated_range(const EvalArguments& arguments);

/// Throws InputError unless the text has three or seven numbers, with a unit quaternion.
ReferenceBody reference_body(const EvalArguments& arguments);

/// Throws InputError for a folder among the estimates, and for covariances of several estimates.
void check_estimates(const EvalArguments& arguments);

}  // namespace loopbench::harness
