/// What `eval` is told on its command line, and what that means.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/eval/judgement.hpp"
#include "harness/eval/layout.hpp"

namespace loopbench {

/// Empty words and optionals: the protocol's own.
struct EvalArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::string format = "auto";
  std::string reference_format;               ///< empty: as `format`
  std::optional<std::string> reference_body;  ///< x,y,z[,qx,qy,qz,qw]; none: the estimates' own
  std::string times;                          ///< empty: none
  std::string repeats = "refuse";
  std::optional<double> period;  ///< [s]; none: that of ReadOptions
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
  std::optional<double> min_coverage;  ///< none: half of what another estimate covers
  std::string relation;
  std::optional<double> delta;
  std::string delta_unit;
  bool all_pairs = false;
  bool pairs_from_reference = false;
  bool json = false;
  bool csv = false;
  std::string per_pose;  ///< file; empty: none
};

/// Throws InputError for an unknown protocol or setting text, OptionError for a wrong one.
std::vector<NamedProtocol> protocols(const EvalArguments& arguments);

/// evo's habits: a relation asks for ape and rpe in it; a delta or unit alone for one rpe. Without
/// any the usual questions. Throws OptionError.
std::vector<Asked> questions(const EvalArguments& arguments, const Protocol& protocol);

/// Throws InputError when it is not three or seven numbers, the latter a unit quaternion's.
ReferenceBody reference_body(const EvalArguments& arguments);

/// REF with each EST, or the files of an rpg folder (no EST) or of ov_eval folders (REF and EST).
/// Throws InputError.
std::vector<FilePair> file_pairs(const EvalArguments& arguments);

}  // namespace loopbench
