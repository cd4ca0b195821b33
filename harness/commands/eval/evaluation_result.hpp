/// Evaluation of one trajectory file under one protocol, and the output of `eval`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/answers/report/curve.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/result.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/metric.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

/// The scores are records, as of a sweep; the rest is what they do not contain.
struct EvaluationResult {
  std::string reference;
  std::string reference_body;  ///< body_from_reference as given; empty: identity
  std::string estimate;
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  metrics::NamedProtocol protocol;
  metrics::Coverage coverage;
  std::string incomplete_reason;  ///< set if coverage is below the limit; the scores remain
  metrics::Alignment alignment;
  std::vector<metrics::Score> diagnosis;  ///< metric `diagnostics` with its defaults
  std::string other_body;                 ///< set if the reference seems to track another body
  std::vector<Note> notes;                ///< of the readers, the doctor and the evaluation
  std::vector<metrics::PoseError> poses;  ///< only on request
  std::vector<PoseValues> pose_values;    ///< of metrics, for each of `poses`; with them
  /// Only on request: the complete reference and the paired and aligned estimate, without a name
  /// and with errors: error [m], angle [deg], and sorted_errors [m] of all poses. Times count from
  /// the first pose of the reference file, so that all its estimates have one origin.
  std::vector<DrawnCurve> drawn;
  std::string why_failed;       ///< set if the evaluation failed
  bool names_files = false;     ///< `why_failed` does
  std::vector<Record> records;  ///< none if the evaluation failed
};

/// ok, incomplete, undefined (all requested metrics are) or failed (the evaluation, or metrics
/// while no other has a score); and the reason if not ok.
std::pair<std::string, std::string> status_of(const EvaluationResult& result);

/// What a text shows: ATE, RPE over 1 s and coverage; the requested scores; or all scores and the
/// diagnosis.
enum class Detail { summary, scores, all };

/// Properties of the evaluation, and a row of comparison() or a table of the scores with six
/// decimals. With a style, lines have at most style.width columns, and numbers four significant
/// digits if they do not fit.
std::string text(const EvaluationResult& result,
                 const std::optional<TerminalStyle>& style = {},
                 Detail detail = Detail::all);

/// One table for each protocol, one row for each estimate: the protocol's statistic
/// of the combined errors (axis 3d or all), not of single axes or lengths, and the coverage.
std::vector<Table> comparison(const std::vector<EvaluationResult>& results,
                              Detail detail = Detail::all);

/// Array of objects, also for one evaluation; doubles in full precision. Keys: reference,
/// reference_body (if given), other_body (if detected), estimate, protocol {name, version,
/// changes, rules}, status (see above), why, pairs, possible, coverage (pairs / possible), span,
/// alignment {type, scale, rank, condition, and reference_from_estimate as x, y, z, qx, qy, qz, qw,
/// so that `traj transform --left FILE` reads it}, diagnosis {name: value}, notes [text], facts
/// [the notes as data, see note_json.hpp], metrics
/// [{metric, label, relation, axis, unit, rmse, mean, median, std, min, max, count}], undefined and
/// failed [{metric, label, relation, axis, why}], without relation and axis if all scores of the
/// metric are. Failed evaluations have empty metrics, undefined and failed.
std::string json(const std::vector<EvaluationResult>& results);

/// An estimate that was aligned without an evaluation.
struct AlignedFile {
  std::string reference;
  std::string estimate;
  std::size_t pairs = 0;
  metrics::Alignment alignment;
};

/// Array of objects with the keys of the members, as those of an evaluation.
std::string json(const std::vector<AlignedFile>& files);

/// Column of pose_csv(): "height_m".
std::string column_name(const PoseValues& values);

/// One line per pose; doubles in full precision. Columns column_name() of what metrics state for
/// each pose follow, empty where a result has none.
std::string pose_csv(const std::vector<EvaluationResult>& results);

/// Converts all scores in metres (to mm, cm or km) or in degrees (to rad). Throws InputError for
/// another unit, or if there is no such score.
void change_unit(std::vector<Record>& records, const std::string& unit);

}  // namespace loopbench::harness
