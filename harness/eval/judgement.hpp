/// Two trajectory files laid side by side, without a sweep: what `eval` computes and shows.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/formats.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench {

/// A metric and the options it is asked with.
struct Asked {
  std::string metric;
  Params options;  ///< those that differ from the defaults of the metric
};

/// ate, axis_error and segments at their defaults (segments length by length where they are the
/// protocol's own), rpe over 1 frame, 1 s and 1 m (once for random
/// pairs). Coverage and diagnostics stand above the table;
/// metrics that need more than two files, or a choice of options to mean something, are left to
/// sweeps.
std::vector<Asked> usual_questions(const Protocol& protocol);

struct JudgeOptions {
  std::vector<Asked> questions;
  bool with_poses = false;
  double min_coverage = 0.0;              ///< below it a judgement is incomplete, 0..1
  const PrintedPoses* printed = nullptr;  ///< when both files are of matrices: their digits
  ReadFindings mended = {};               ///< of both files together
  Pose body_from_reference = {};          ///< that the reference was moved by
};

struct JudgedMetric {
  std::string name;
  Params options;
  std::vector<Score> scores;
  std::string why_undefined;  ///< set instead of scores
};

struct Judgement {
  std::string reference;
  std::string reference_body;  ///< body_from_reference as typed; empty: they are the same
  std::string estimate;
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  NamedProtocol protocol;
  Coverage coverage;
  std::string why_incomplete;  ///< set when coverage is below the limit; the numbers stand
  Alignment alignment;
  std::vector<Score> diagnosis;    ///< of `diagnostics` at its defaults
  std::string other_body;          ///< set when the reference seems to follow another one
  std::vector<std::string> notes;  ///< see evaluation_notes.hpp
  std::vector<JudgedMetric> metrics;
  std::vector<PoseError> poses;  ///< only when asked for
  std::string why_failed;        ///< set when nothing could be judged: names and protocol only
};

/// It failed, or everything asked for is undefined.
bool has_no_number(const Judgement& judgement);

/// ok, incomplete, undefined (everything asked for is) or failed; and why not ok.
std::string status(const Judgement& judgement);
std::string why_not_ok(const Judgement& judgement);

/// The limits of coverage are those of sweeps. A metric that is undefined here says why; throws
/// std::runtime_error only when nothing can be judged.
Judgement judge(const Trajectory& reference,
                const Trajectory& estimate,
                const NamedProtocol& protocol,
                const JudgeOptions& options);

/// Makes incomplete what covers less than half of what another estimate covers under the same
/// reference and protocol, by the smaller share of each.
void compare_coverage(std::vector<Judgement>& judgements);

/// "rpe 1 s": a metric and its options, short enough for a column.
std::string label(const JudgedMetric& metric);

/// A table for people, numbers with six decimals.
std::string text(const Judgement& judgement);

/// One table for each protocol, a row for each estimate: both shares of coverage, and the statistic
/// that the protocol quotes, of whole errors (axis 3d or all), not of single axes or lengths. A
/// metric whose numbers are of other pairs than the judged poses has them in a column.
std::string comparison(const std::vector<Judgement>& judgements);

/// An array of objects, also for one judgement; doubles in full precision. Keys: reference,
/// reference_body (if given), other_body (if it seems so), estimate, protocol {name, version,
/// changes, rules}, status (see above), why, pairs, possible, coverage (pairs / possible), span,
/// alignment {type, scale, rank, condition}, diagnosis {name: value}, notes [text], metrics
/// [{metric, options, relation, axis, unit, rmse, mean, median, std, min, max, count}], undefined
/// [{metric, options, why}], with relation and axis when only one number of a metric is. What
/// failed has no numbers, but empty metrics and undefined.
std::string json(const std::vector<Judgement>& judgements);

/// A line per score, one for what failed, a line per judged pose; doubles in full precision.
std::string csv(const std::vector<Judgement>& judgements);
std::string pose_csv(const std::vector<Judgement>& judgements);

}  // namespace loopbench
