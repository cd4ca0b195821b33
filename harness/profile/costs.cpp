#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "harness/profile/grouping.hpp"
#include "harness/profile/profile.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

constexpr double kMegabyte = 1e6;

std::string milliseconds(double seconds) { return fmt::format("{:.4g}", 1e3 * seconds); }

/// Median over the cells that have the value, as text; otherwise a dash.
template <class Get, class Text>
std::string median_text(const std::vector<const CellRecord*>& cells, Get get, Text text) {
  std::vector<double> values;
  for (const CellRecord* cell : cells) {
    if (const auto value = get(*cell)) values.push_back(static_cast<double>(*value));
  }
  return values.empty() ? "-" : text(metrics::median(values));
}

template <class Get>
std::string largest_megabytes(const std::vector<const CellRecord*>& cells, Get get) {
  std::optional<std::int64_t> out;
  for (const CellRecord* cell : cells) {
    if (const auto value = get(*cell)) out = std::max(out.value_or(0), *value);
  }
  return out ? fmt::format("{:.1f}", static_cast<double>(*out) / kMegabyte) : "-";
}

std::optional<double> iterations(const CellRecord& cell) {
  const auto found = std::ranges::find(cell.counts, "iterations", &methods::Count::name);
  return found == cell.counts.end() ? std::nullopt : std::optional(found->value);
}

std::vector<const CellRecord*> timed_of(const std::vector<const CellRecord*>& cells) {
  std::vector<const CellRecord*> out;
  std::ranges::copy_if(
      cells, std::back_inserter(out), [](const auto* c) { return is_finished(*c); });
  return out;
}

std::string plain(double value) { return fmt::format("{:.6g}", value); }

/// Medians by name, names in order of first appearance.
class ByName {
 public:
  void add(const std::string& name, double value) {
    if (!values_.contains(name)) names_.push_back(name);
    values_[name].push_back(value);
  }
  template <class Text>
  void add_rows(TableView& out,
                const std::string& method,
                const std::string& what,
                Text text) const {
    for (const std::string& name : names_) {
      out.lines.push_back({method, what, name, text(metrics::median(values_.at(name)))});
    }
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::vector<double>> values_;
};

}  // namespace

TableView costs(const std::vector<CellRecord>& cells) {
  TableView out{"costs",
                {"method",
                 "cells",
                 "failed",
                 "wall [ms]",
                 "CPU [ms]",
                 "peak memory [MB]",
                 "added [MB]",
                 "allocations",
                 "iterations"},
                {},
                {}};
  if (lacks_times(cells)) {
    out.notes.push_back(kNoTimes);
    return out;
  }
  bool shared = false;
  bool alone = false;
  for (const auto& [method, all] : by_method(cells)) {
    const std::vector<const CellRecord*> timed = timed_of(all);
    std::size_t failed = 0;
    for (const CellRecord* cell : all) {
      if (!has_numbers(cell->status) && cell->status != Status::declined) ++failed;
      (cell->worker.text().find("serial") == std::string::npos ? shared : alone) = true;
    }
    out.lines.push_back(
        {table_name(method, all),
         std::to_string(all.size()),
         std::to_string(failed),
         median_text(
             timed, [](const auto& c) { return std::optional(c.seconds); }, milliseconds),
         median_text(
             timed, [](const auto& c) { return c.cpu_seconds; }, milliseconds),
         largest_megabytes(timed, [](const auto& c) { return c.peak_memory; }),
         largest_megabytes(timed, [](const auto& c) { return c.added_memory; }),
         median_text(
             timed, [](const auto& c) { return c.allocations; }, plain),
         median_text(timed, iterations, plain)});
  }
  out.notes.push_back(
      "medians over cells; memory: the largest resident size of the process while the method "
      "ran, and its increase (memory that an earlier cell returned to the allocator is reused "
      "without being counted)");
  if (shared) {
    out.notes.push_back(
        std::string(alone ? "some" : "all") +
        " cells ran in parallel with others; `timing: true` in the config runs them one at a time");
  }
  std::ranges::move(oracle_notes(cells), std::back_inserter(out.notes));
  return out;
}

TableView reported(const std::vector<CellRecord>& cells) {
  TableView out{"reported by the methods", {"method", "what", "name", "median"}, {}, {}};
  for (const auto& [method, all] : by_method(cells)) {
    ByName phases;
    ByName counts;
    for (const CellRecord* cell : timed_of(all)) {
      for (const methods::Phase& phase : cell->phases) phases.add(phase.name, phase.seconds);
      for (const methods::Count& count : cell->counts) counts.add(count.name, count.value);
    }
    phases.add_rows(out, table_name(method, all), "phase [ms]", milliseconds);
    counts.add_rows(out, table_name(method, all), "count", plain);
  }
  std::ranges::move(oracle_notes(cells), std::back_inserter(out.notes));
  return out;
}

}  // namespace loopbench::harness
