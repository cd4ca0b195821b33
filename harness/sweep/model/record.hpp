/// One line of the long table: a score with its cell and what it is.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "harness/sweep/model/choice.hpp"
#include "harness/sweep/model/method_parts.hpp"
#include "harness/sweep/model/note.hpp"
#include "harness/sweep/model/run_group.hpp"
#include "harness/sweep/model/shared.hpp"
#include "harness/sweep/model/shared_text.hpp"
#include "harness/sweep/model/status.hpp"
#include "methods/report.hpp"
#include "metrics/better.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::harness {

/// What is measured in the process of a cell. A new fact is a member and a line of
/// measured_fields(), which drive its way to the store and out of it.
struct MeasuredFacts {
  std::optional<double> waiting;             ///< share of the wall time without a processor, 0..1
  std::optional<std::int64_t> peak_memory;   ///< of the process [bytes]
  std::optional<std::int64_t> added_memory;  ///< increase of the resident size [bytes]
};

/// What is known about a cell, apart from its scores; fields() lists its columns.
struct CellRow : MeasuredFacts {
  std::int64_t position = 0;  ///< in the sweep
  std::string key;            ///< content key: equal keys mean equal results
  SharedText build;
  SharedText sequence;
  std::int64_t repeat = 0;
  SharedText method;  ///< label, which means nothing but itself
  MethodParts parts;
  SharedText dataset_options;
  SharedText method_options;
  /// Of a cell that was read from a store: its dataset with the options that the config sets (one
  /// entry), and the stages of its method with all options.
  Shared<std::vector<Choice>> dataset;
  Shared<std::vector<Choice>> stages;
  SharedText closures;
  bool oracle_closures = false;
  bool oracle = false;  ///< the method has access to the reference
  SharedText group;     ///< runs of one group are not independent; empty: a group of its own
  GroupKind group_kind = GroupKind::none;
  SharedText recording;  ///< runs of one recording, see SequenceMetadata; empty: unknown
  SharedText content;    ///< hash of problem and reference, equal for equal inputs; can be empty
  std::int64_t keyframes = 0;      ///< of the sequence; 0: it could not be loaded
  std::int64_t closure_count = 0;  ///< of the sequence
  SharedText worker;          ///< "isolated" or "in process", with ", serial" and ", pinned" if so
  bool serial = false;        ///< no other cell of the sweep ran at the same time
  bool stated_times = false;  ///< the times are statements of a program
  std::int64_t runs = 0;      ///< that were timed
  double seconds = 0.0;       ///< time of the method: median, then minimum and maximum
  double seconds_min = 0.0;
  double seconds_max = 0.0;
  std::optional<double> cpu_seconds;  ///< median
  std::optional<double> cpu_seconds_min;
  std::optional<double> cpu_variation;  ///< standard deviation by mean; none of a single run
  Status status = Status::ok;
  SharedText signal;
  SharedText why;
  std::vector<methods::Phase> phases;
  std::vector<methods::Count> counts;
  std::vector<Note> notes;

  /// Median time of the method; NaN: not recorded.
  double milliseconds() const;

  /// Whether that time is the statement of a program.
  bool is_stated() const { return stated_times; }

  /// "room" or "room (repeat 2)".
  std::string run_name() const;

  /// "room (repeat 2) / uniform".
  std::string name() const { return run_name() + " / " + method; }
};

/// What a score is: the same for all its values. Kinds are equal if they are one score; its
/// direction follows from that.
struct ScoreKind {
  std::string protocol;  ///< label; empty if not applicable, as are the next two
  std::string protocol_version;
  std::string times;   ///< keyframes | dense
  std::string metric;  ///< catalogue name; or gain, pairs, time; empty: no score
  std::string label;   ///< of the metric in the config; empty: the metric's name
  std::string relation;
  std::string axis;
  std::string unit;
  metrics::Better better = metrics::Better::lower;
  double target = 0.0;  ///< best value where `better` is target

  auto id() const {
    return std::tie(relation, axis, label, metric, unit, times, protocol, protocol_version);
  }
  friend auto operator<=>(const ScoreKind& a, const ScoreKind& b) { return a.id() <=> b.id(); }
  friend bool operator==(const ScoreKind& a, const ScoreKind& b) { return a.id() == b.id(); }

  /// Name of the metric in tables: its label in the config, or its name.
  const std::string& metric_label() const { return label.empty() ? metric : label; }

  /// "ate", "error x": without the defaults (translation; rotation, implied by the unit; 3d).
  std::string short_name() const;

  /// "ate translation 3d, dense, loopbench".
  std::string name() const;

  /// Whether it is over all axes.
  bool is_total() const { return axis.empty() || axis == "3d" || axis == "all"; }
};

/// A text of a kind with its name in stores, tables and baselines.
struct KindField {
  const char* name;
  std::string ScoreKind::*text;
};
inline constexpr KindField kKindFields[] = {{"protocol", &ScoreKind::protocol},
                                            {"protocol_version", &ScoreKind::protocol_version},
                                            {"times", &ScoreKind::times},
                                            {"metric", &ScoreKind::metric},
                                            {"label", &ScoreKind::label},
                                            {"relation", &ScoreKind::relation},
                                            {"axis", &ScoreKind::axis},
                                            {"unit", &ScoreKind::unit}};

/// A score of a cell. A declined or failed cell has one without a metric, with the reason.
struct Record {
  Shared<CellRow> cell;
  Shared<ScoreKind> kind;
  metrics::Statistics statistics;
  std::int64_t pairs = 0;     ///< evaluated pose pairs
  std::int64_t possible = 0;  ///< possible pose pairs; 0: unknown
  double span = 1.0;          ///< evaluated share of the reference's time, 0..1
  Status status = Status::ok;
  SharedText why;

  bool has_score() const { return !kind->metric.empty(); }
};

/// Text in the named column of a record: sequence, repeat, method, closures, protocol,
/// protocol_version, times, metric, label, relation, axis, unit, status, `score`: the short name,
/// or an option of its method. Throws InputError with a suggestion for another name.
std::string field(const Record& record, const std::string& name);

/// Whether field() accepts the name; Record() has no options.
bool has_field(const Record& record, const std::string& name);

/// Value of a record's named statistic; p50 is the median. Throws InputError with a suggestion for
/// another name.
double value(const Record& record, const std::string& name);

/// The member of a statistic other than count; throws likewise.
double metrics::Statistics::*member_of(const std::string& statistic);

/// Names of all statistics: rmse, mean, ..., count.
std::vector<std::string> statistic_names();

/// Whether values of a statistic can be better than others: not those of count, nor of sse, which
/// is smaller for an estimate with fewer poses.
bool has_direction(const std::string& statistic);

/// Names of the statistics that have a direction.
std::vector<std::string> directed_statistics();

/// Direction and unit of value(): neither without a direction; no unit for count, the squared unit
/// for sse.
metrics::Better direction_of(const ScoreKind& kind, const std::string& statistic);
std::string unit_of(const ScoreKind& kind, const std::string& statistic);

/// Of the metric `gain` -1, of `change` 1: 100 * sign * (ratio to the baseline - 1); of others 0.
int sign_of_ratio(const std::string& metric);

}  // namespace loopbench::harness
