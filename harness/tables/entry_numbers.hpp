/// The numbers that are aggregated in one entry of a table.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/mark_best.hpp"

namespace loopbench::harness {

/// Key of a run within an entry: the content of its data if known, otherwise its name.
std::string run_key(const Record& record);

class EntryNumbers {
 public:
  void add(const Record& record, double value);

  /// Number of added records.
  std::size_t size() const { return added_; }
  /// Number of averaged records: added and kept.
  std::size_t averaged() const { return values_.size(); }
  /// Names of the runs with a value.
  std::set<std::string> finished() const;
  /// Restricts the average to the records of these runs.
  void keep(const std::set<std::string>& runs);

  /// The mean; for gains 1 - the geometric mean ratio, over groups as in a verdict. nullopt if that
  /// is not a number.
  std::optional<double> average() const;
  /// Sample standard deviation of the averaged values; nullopt for fewer than two.
  std::optional<double> deviation() const;

  const ByRun& runs() const { return runs_; }  ///< without oracles
  const std::string& method() const { return method_; }
  metrics::Better better() const { return better_; }
  double target() const { return target_; }
  bool is_gain() const { return is_gain_; }

 private:
  struct Value {
    std::string run;
    std::string group;
    std::string method;
    double value = 0.0;
  };

  double gain() const;

  std::vector<Value> values_;
  std::size_t added_ = 0;
  ByRun runs_;
  std::string method_;
  metrics::Better better_ = metrics::Better::neither;
  double target_ = 0.0;
  bool is_gain_ = false;
};

}  // namespace loopbench::harness
