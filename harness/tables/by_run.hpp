/// Runs of one entry of a table, as numbers in order of appearance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <vector>

namespace loopbench::harness {

/// Room for runs when the first is added: most entries have several.
inline constexpr std::size_t kFirstRuns = 8;

/// Different runs in ascending order. insert() is O(1) in that order, otherwise O(n).
class RunSet {
 public:
  RunSet() = default;
  RunSet(std::initializer_list<std::size_t> runs) {
    for (const std::size_t run : runs) insert(run);
  }

  auto begin() const { return runs_.begin(); }
  auto end() const { return runs_.end(); }

  void insert(std::size_t run) {
    if (runs_.empty()) reserve(kFirstRuns);
    if (runs_.empty() || runs_.back() < run) {
      runs_.push_back(run);
      return;
    }
    const auto place = std::ranges::lower_bound(runs_, run);
    if (*place != run) runs_.insert(place, run);
  }
  void insert(const RunSet& others) {
    for (const std::size_t run : others) insert(run);
  }
  void reserve(std::size_t runs) { runs_.reserve(runs); }
  bool contains(std::size_t run) const { return std::ranges::binary_search(runs_, run); }
  bool intersects(const RunSet& other) const {
    return std::ranges::any_of(runs_, [&](std::size_t run) { return other.contains(run); });
  }
  /// Removes the runs that are not in `other`.
  void keep(const RunSet& other) {
    if (*this == other) return;
    std::erase_if(runs_, [&](std::size_t run) { return !other.contains(run); });
  }

  std::size_t size() const { return runs_.size(); }
  bool empty() const { return runs_.empty(); }
  bool operator==(const RunSet&) const = default;

 private:
  std::vector<std::size_t> runs_;
};

/// The value of a run; nullopt if the method failed.
struct RunValue {
  std::size_t run = 0;
  std::optional<double> value = {};
};

/// The values of one entry, ascending by run. set() and add() are O(1) in that order.
class ByRun {
 public:
  /// Replaces a value that is there.
  void set(std::size_t run, std::optional<double> value) { place(run).value = value; }
  /// Adds a failure unless the run is there.
  void add_failure(std::size_t run) { place(run); }
  void reserve(std::size_t runs) { values_.reserve(runs); }
  void erase(std::size_t run) {
    std::erase_if(values_, [&](const RunValue& one) { return one.run == run; });
  }
  bool contains(std::size_t run) const {
    const auto found = std::ranges::lower_bound(values_, run, {}, &RunValue::run);
    return found != values_.end() && found->run == run;
  }

  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }

 private:
  RunValue& place(std::size_t run) {
    if (values_.empty() || values_.back().run < run) return values_.emplace_back(RunValue{run});
    const auto found = std::ranges::lower_bound(values_, run, {}, &RunValue::run);
    return found->run == run ? *found : *values_.insert(found, RunValue{run});
  }

  std::vector<RunValue> values_;
};

}  // namespace loopbench::harness
