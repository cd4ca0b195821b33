/// Command line arguments of `eval` and their interpretation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/eval/error_figures.hpp"
#include "harness/eval/evaluation_result.hpp"
#include "harness/eval/layout.hpp"

namespace loopbench::harness {

/// Empty strings and optionals mean the protocol's value.
struct EvalArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::string format = "auto";
  std::string reference_format;               ///< empty: same as `format`
  std::optional<std::string> reference_body;  ///< x,y,z[,qx,qy,qz,qw]; none: no offset
  std::string times;                          ///< empty: none
  std::string repeats = "refuse";
  std::optional<double> period;  ///< [s]; none: default of ReadOptions
  std::vector<std::string> protocols{"loopbench"};
  std::vector<std::string> settings;  ///< FIELD=VALUE of the protocol
  std::string association;
  std::string align;
  bool correct_scale = false;
  std::optional<int> align_first;
  std::string project;
  std::optional<double> max_diff;
  std::optional<double> max_gap;
  std::optional<double> offset;
  std::optional<double> min_coverage;  ///< none: half of the best coverage of another estimate
  std::string relation;
  std::optional<double> delta;
  std::string delta_unit;
  bool all_pairs = false;
  bool pairs_from_reference = false;
  bool json = false;
  bool csv = false;
  std::string per_pose;  ///< output file; empty: none
  std::string plot;      ///< prefix of figure files; empty: none
  ErrorFigureSize plot_size;
  std::string report;    ///< HTML file; empty: none
  std::string store;     ///< folder of a store for the results; empty: none
  std::string sequence;  ///< label of the reference in the store; empty: from its file name
};

/// Throws InputError for an unknown or repeated protocol or a malformed setting, OptionError for an
/// invalid one.
std::vector<metrics::NamedProtocol> protocols(const EvalArguments& arguments);

/// As in evo: a relation selects ape and rpe in that relation; a delta or unit alone selects one
/// rpe. Otherwise the default metrics. Throws OptionError.
std::vector<MetricRequest> metric_requests(const EvalArguments& arguments,
                                           const metrics::Protocol& protocol);

/// Throws InputError unless the text has three or seven numbers, with a unit quaternion.
ReferenceBody reference_body(const EvalArguments& arguments);

/// Pairs REF with each EST, or lists the files of an rpg folder (no EST) or of ov_eval folders (REF
/// and EST). Throws InputError.
std::vector<FilePair> file_pairs(const EvalArguments& arguments);

}  // namespace loopbench::harness
