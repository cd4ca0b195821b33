/// Corrects one trajectory or pose graph with one method, without a sweep.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/answers/report/draw.hpp"
#include "harness/commands/correct/closure_check.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/entry.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

struct CorrectArguments {
  std::string estimate;  ///< trajectory in any known format, or a g2o graph
  /// NAME[:option=value,...][ + NAME[:...]]; empty: consensus, or pose_graph if that does not apply
  std::string method;
  bool trusts_loops = false;  ///< without a method: pose_graph with all closures
  bool gravity = false;       ///< option `gravity` of the method
  std::string loops;          ///< closure file or g2o graph for a trajectory; empty: none
  std::string anchors;        ///< measured positions for a trajectory; empty: none
  std::optional<double> start_equals_end = {};  ///< deviation of a closure of the ends [m]
  std::string frames;                           ///< all tracked poses of the run; empty: none
  std::vector<GivenSetting> settings;  ///< OPTION=VALUE of dataset `trajectory` or `pose_graph`
  std::string at;                      ///< trajectory file whose stamps are used; empty: keyframes
  bool dense = false;                  ///< output keyframes and frames
  std::string out;                     ///< empty: no file; "-": standard output
  Format format = Format::tum;         ///< of the file; g2o: a graph with all edges
  std::string ledger;                  ///< file for csv() of loops.hpp; empty: none
};

/// Disagreement of poses with edges of one kind of their problem.
struct Residual {
  const char* key;    ///< in JSON
  const char* title;  ///< with the unit
  double value;
};

struct Correction {
  std::string estimate;
  std::string method;  ///< label with all given options
  Problem problem;
  Trajectory keyframes;  ///< corrected, stamps and order of `problem.keyframes`
  Trajectory output;     ///< at the requested stamps, ascending; the corrected keyframes by default
  std::size_t outside = 0;  ///< requested stamps outside the keyframes' time span, not in `output`
  /// Of all edges but rejected closures; unset if an edge changes the scale or measures so much
  /// that its squared error is not finite.
  std::optional<std::vector<Residual>> before;
  std::optional<std::vector<Residual>> after;
  std::string why_no_residuals;         ///< empty: there are residuals
  std::optional<std::size_t> rejected;  ///< closures; unset: the method rejects none
  Provenance provenance = {};           ///< of the file
  double seconds = 0.0;                 ///< wall time of the method
  methods::Report report;
  std::string out;                    ///< file that was written; empty: none
  std::optional<ClosureCheck> check;  ///< unset: no closures, or the method uses none
  bool is_consensus = false;          ///< the method follows the check
};

/// A method as in a config, with its options: NAME:option=value,... Throws InputError also for an
/// oracle.
MethodChoice method_without_reference(const std::string& text, const Catalogue& catalogue);

/// Runs the method on a problem in memory, which must be valid; `output` is at the stamps `at`,
/// ascending and within the keyframes' time span. `name` is for messages, `closure_check` that of
/// the problem if it was computed. Throws InputError if the
/// method declines; other exceptions of the method are not caught.
Correction correct(Problem problem,
                   const std::string& name,
                   const MethodChoice& choice,
                   const std::vector<double>& at,
                   const Catalogue& catalogue,
                   const ClosureCheck* closure_check = nullptr);

/// Loads the input as the datasets `trajectory` and `pose_graph` of a sweep do, judges the
/// closures, runs the method and writes the output file. Numbers are written so that reading them
/// is bit-identical. Without a method, consensus corrects, or pose_graph if the closures cannot be
/// judged or are trusted. Computes the ledger of the closures if its file is wanted; a note states
/// why it is not written. Throws InputError, also if the method declines or fails.
Correction correct(const CorrectArguments& arguments, const Catalogue& catalogue);

/// The problem that correct() would correct, from `estimate`, `loops`, `anchors`, `frames` and
/// `settings`. Sets `provenance` to that of its dataset unless it is null. Throws InputError.
Problem load_problem(const CorrectArguments& arguments,
                     const Catalogue& catalogue,
                     Provenance* provenance = nullptr);

/// Result of the check of the closures in words; empty without a check.
CheckSentence check_sentence(const Correction& correction);

/// Summary for a terminal: sizes, what the check of the closures found, residuals before and after,
/// counts and notes of the method.
std::string text(const Correction& correction);

/// Map of the keyframes before and after, without files.
FigureData before_and_after(const Correction& correction);

/// Object with keys estimate, method, keyframes, odometry, closures, anchors, rejected,
/// rejected_closures [{from, to}] by ids or stamps, seconds, before, after {translation_rms,
/// translation_max, rotation_rms, rotation_max, chi2_odometry, chi2_closures, and with anchors
/// anchor_rms, anchor_max (of all anchors, also dropped ones)} or null, counts {name: value},
/// phases [{name, seconds}], notes [text], verdict (check_sentence() or null), closure_check
/// (closure_check.hpp, or null), output {file, poses, outside}. `rejected` and its list are null if
/// the method rejects none.
std::string json(const Correction& correction);

}  // namespace loopbench::harness
