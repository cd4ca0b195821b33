#include <fmt/format.h>

#include <map>

#include "harness/profile/grouping.hpp"
#include "harness/profile/profile.hpp"

namespace loopbench {
namespace {

constexpr double kMegabyte = 1e6;

std::string milliseconds(double seconds) { return fmt::format("{:.4g}", 1e3 * seconds); }

/// Median over the cells that know the value, as text; a dash when none does.
template <class Get, class Text>
std::string median_text(const std::vector<const CellRecord*>& cells, Get get, Text text) {
  std::vector<double> values;
  for (const CellRecord* cell : cells) {
    if (const auto value = get(*cell)) values.push_back(static_cast<double>(*value));
  }
  return values.empty() ? "-" : text(median_of(std::move(values)));
}

template <class Get>
std::string largest_megabytes(const std::vector<const CellRecord*>& cells, Get get) {
  std::optional<std::int64_t> out;
  for (const CellRecord* cell : cells) {
    if (const auto value = get(*cell)) out = std::max(out.value_or(0), *value);
  }
  return out ? fmt::format("{:.1f}", static_cast<double>(*out) / kMegabyte) : "-";
}

/// "correct 0.12, smooth 0.03": medians of what the method reported, in its order.
template <class Items, class Value, class Text>
std::string reported(const std::vector<const CellRecord*>& cells,
                     Items items,
                     Value value,
                     Text text) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> values;
  for (const CellRecord* cell : cells) {
    for (const auto& item : items(*cell)) {
      if (!values.contains(item.name)) names.push_back(item.name);
      values[item.name].push_back(value(item));
    }
  }
  std::string out;
  for (const std::string& name : names) {
    out += (out.empty() ? "" : ", ") + name + " " + text(median_of(values[name]));
  }
  return out.empty() ? "-" : out;
}

}  // namespace

Listing costs(const std::vector<CellRecord>& cells) {
  Listing out{"costs",
              {"method",
               "cells",
               "failed",
               "wall [ms]",
               "CPU [ms]",
               "peak memory [MB]",
               "added [MB]",
               "allocations",
               "counts",
               "phases [ms]"},
              {},
              {}};
  bool shared = false;
  bool alone = false;
  for (const auto& [method, all] : by_method(cells)) {
    std::vector<const CellRecord*> timed;
    std::size_t failed = 0;
    for (const CellRecord* cell : all) {
      if (is_timed(*cell)) timed.push_back(cell);
      if (!is_timed(*cell) && cell->status != "declined") ++failed;
      (cell->worker.find("serial") == std::string::npos ? shared : alone) = true;
    }
    const auto plain = [](double value) { return fmt::format("{:.6g}", value); };
    out.rows.push_back(
        {method,
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
         reported(
             timed,
             [](const auto& c) { return c.counts; },
             [](const Count& count) { return count.value; },
             plain),
         reported(
             timed,
             [](const auto& c) { return c.phases; },
             [](const Phase& phase) { return phase.seconds; },
             milliseconds)});
  }
  out.notes.push_back(
      "medians over cells; memory: the largest of the whole process while the "
      "method ran, and what it added to it (memory that an earlier cell gave back "
      "to the allocator is used again unseen)");
  if (shared) {
    out.notes.push_back(std::string(alone ? "some" : "all") +
                        " cells ran beside others: `timing: true` in the config runs them alone");
  }
  return out;
}

}  // namespace loopbench
