/// The numbers that fell into one cell of a table.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/export/mark_best.hpp"
#include "harness/store/record.hpp"

namespace loopbench {

/// What tells the runs of a cell apart: the data of the run where it is known, else its name.
std::string run_key(const Record& record);

class CellNumbers {
 public:
  void add(const Record& record, double value);

  /// Records that were added.
  std::size_t size() const { return added_; }
  /// Records that are averaged: added and kept.
  std::size_t averaged() const { return values_.size(); }
  /// Names of their runs.
  std::set<std::string> finished() const;
  /// Leaves only the records of these runs to the average.
  void keep(const std::set<std::string>& runs);

  /// The mean; of gains 1 - the geometric mean ratio, over groups as a verdict has it. None where
  /// that is not a number.
  std::optional<double> average() const;

  const ByRun& runs() const { return runs_; }  ///< without those that were shown the reference
  const std::string& method() const { return method_; }
  Better better() const { return better_; }
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
  Better better_ = Better::neither;
  double target_ = 0.0;
  bool is_gain_ = false;
};

}  // namespace loopbench
