/// The numbers that are aggregated in one entry of a table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/by_run.hpp"

namespace loopbench::harness {

/// Key of a run within an entry: the content of its data if known, otherwise its name.
std::string run_key(const Record& record);

class EntryNumbers {
 public:
  /// `run` and `group`: numbers of run_key() and group_name(). Throws InputError for an unknown
  /// statistic.
  void add(const Record& record, std::size_t run, std::size_t group, const std::string& statistic);

  /// Number of added records.
  std::size_t size() const { return values_.size(); }
  /// Number of averaged records: added and kept.
  std::size_t averaged() const;
  /// The runs of the averaged records.
  RunSet finished() const;
  /// Restricts the average to the records of these runs.
  void keep(const RunSet& runs);

  /// The mean; for gains 1 - the geometric mean ratio, over groups as in a verdict. nullopt if that
  /// is not a number.
  std::optional<double> average() const;
  /// Sample standard deviation of the averaged values; nullopt for fewer than two.
  std::optional<double> deviation() const;

  ByRun runs() const;  ///< added values; none of an oracle
  const SharedText& method() const { return method_; }
  metrics::Better better() const { return better_; }
  double target() const { return target_; }
  bool is_gain() const { return is_gain_; }

 private:
  struct Value {
    std::size_t run = 0;
    std::size_t group = 0;
    SharedText method;
    double value = 0.0;
    bool is_kept = true;
  };

  double gain() const;
  std::vector<double> kept() const;

  std::vector<Value> values_;
  SharedText method_;
  metrics::Better better_ = metrics::Better::neither;
  double target_ = 0.0;
  bool is_gain_ = false;
  bool is_oracle_ = false;
};

}  // namespace loopbench::harness
