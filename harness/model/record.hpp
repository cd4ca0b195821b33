/// One line of the long table: a score with all its labels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/shared_text.hpp"
#include "harness/model/status.hpp"
#include "methods/report.hpp"
#include "metrics/better.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::harness {

/// In `CellRecord::worker`: the times are statements of a program.
inline constexpr const char* kStatedTimes = ", times as stated";

/// A declined or failed cell has one record with empty metric and the reason.
struct Record {
  std::int64_t cell = 0;  ///< position in the sweep
  SharedText sequence;
  std::int64_t repeat = 0;
  SharedText method;
  SharedText closures;
  bool oracle_closures = false;
  bool oracle = false;        ///< the method has access to the reference
  double milliseconds = 0.0;  ///< median time of the method; NaN: not recorded
  bool is_stated = false;     ///< that time is the statement of a program
  SharedText protocol;        ///< label; empty if not applicable, as are the next two
  SharedText protocol_version;
  SharedText times;   ///< keyframes | dense
  SharedText metric;  ///< catalogue name; or gain, pairs, time
  SharedText label;   ///< of the metric in the config; empty: the metric's name
  SharedText relation;
  SharedText axis;
  SharedText unit;
  metrics::Better better = metrics::Better::lower;
  double target = 0.0;  ///< best value where `better` is target
  SharedText group;     ///< runs of one group are not independent; empty: a group of its own
  SharedText content;   ///< hash of problem and reference, equal for equal inputs; can be empty
  metrics::Statistics statistics;
  std::int64_t pairs = 0;     ///< evaluated pose pairs
  std::int64_t possible = 0;  ///< possible pose pairs; 0: unknown
  double span = 1.0;          ///< evaluated share of the reference's time, 0..1
  Status status = Status::ok;
  SharedText why;
};

/// A cell without its scores.
struct CellRecord {
  std::int64_t position = 0;  ///< in the sweep: Record::cell
  std::string key;            ///< content key: equal keys mean equal results
  SharedText build;
  SharedText sequence;
  std::int64_t repeat = 0;
  SharedText method;
  SharedText dataset_options;
  SharedText method_options;
  SharedText closures;
  bool oracle_closures = false;
  bool oracle = false;
  SharedText content;              ///< hash of problem and reference; empty: unknown
  std::int64_t keyframes = 0;      ///< of the sequence; 0: it could not be loaded
  std::int64_t closure_count = 0;  ///< of the sequence
  SharedText worker;  ///< "isolated" or "in process", with ", serial" and ", pinned" if so, and
                      ///< kStatedTimes
  std::int64_t runs = 0;
  double seconds = 0.0;  ///< time of the method: median, then minimum and maximum
  double seconds_min = 0.0;
  double seconds_max = 0.0;
  std::optional<double> cpu_seconds;         ///< median
  std::optional<std::int64_t> peak_memory;   ///< of the process [bytes]
  std::optional<std::int64_t> added_memory;  ///< increase of the resident size [bytes]
  Status status = Status::ok;
  SharedText signal;
  SharedText why;
  std::vector<methods::Phase> phases;
  std::vector<methods::Count> counts;
  std::vector<std::string> notes;
};

/// Name of the record's metric in tables: its label in the config, or its name.
const SharedText& metric_label(const Record& record);

/// Text in the named column of a record: sequence, repeat, method, closures, protocol,
/// protocol_version, times, metric, label, relation, axis, unit, status, or `score`: label,
/// relation and axis without the defaults (translation; rotation, implied by the unit; 3d). Throws
/// InputError with a suggestion for another name.
std::string field(const Record& record, const std::string& name);

/// Value of a record's named statistic; p50 is the median. Throws InputError with a suggestion for
/// another name.
double value(const Record& record, const std::string& name);

/// Names of all statistics: rmse, mean, ..., count.
std::vector<std::string> statistic_names();

/// Whether values of a statistic can be better than others: not those of count, nor of sse, which
/// is smaller for an estimate with fewer poses.
bool has_direction(const std::string& statistic);

/// Names of the statistics that have a direction.
std::vector<std::string> directed_statistics();

/// Direction and unit of value(): neither without a direction; no unit for count, the squared unit
/// for sse.
metrics::Better direction_of(const Record& record, const std::string& statistic);
std::string unit_of(const Record& record, const std::string& statistic);

}  // namespace loopbench::harness
