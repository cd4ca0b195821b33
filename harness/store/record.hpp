/// One line of the long table: a score and everything needed to know what it is a score of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "metrics/statistics.hpp"

namespace loopbench {

/// A cell that was declined or failed has one record with empty metric and its reason.
struct Record {
  std::int64_t cell = 0;
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  std::string closures;
  bool oracle_closures = false;
  bool oracle_method = false;
  double milliseconds = 0.0;  ///< median wall time of the method's verb
  std::string protocol;       ///< label; empty when it does not apply, so the next two
  std::string protocol_version;
  std::string times;  ///< keyframes | dense
  std::string metric;
  std::string relation;
  std::string axis;
  std::string unit;
  Statistics statistics;
  std::int64_t pairs = 0;     ///< pose pairs judged
  std::int64_t possible = 0;  ///< pose pairs that could have been
  std::string status = "ok";
  std::string why;
};

/// The text of a record's named column: sequence, repeat, method, closures, protocol,
/// protocol_version, times, metric, relation, axis, unit, status, or `score`: metric, relation and
/// axis without the usual ones (translation; rotation, which its unit tells; 3d). Throws InputError
/// with a suggestion for another name.
std::string field(const Record& record, const std::string& name);

/// The number of a record's named statistic: rmse, mean, median, std, min, max, sse, count.
/// Throws InputError with a suggestion for another name.
double value(const Record& record, const std::string& name);

}  // namespace loopbench
