#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "harness/report/html.hpp"
#include "harness/report/sections.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

constexpr double kMegabyte = 1e6;

/// Cells by method, methods in order of first appearance.
std::vector<std::pair<std::string, std::vector<const CellRecord*>>> by_method(
    const std::vector<CellRecord>& cells) {
  std::vector<std::pair<std::string, std::vector<const CellRecord*>>> out;
  for (const CellRecord& cell : cells) {
    auto found = std::ranges::find_if(out, [&](const auto& g) { return g.first == cell.method; });
    if (found == out.end()) found = out.insert(out.end(), {cell.method, {}});
    found->second.push_back(&cell);
  }
  return out;
}

/// Name of the method in tables.
std::string table_name(const std::string& method, const std::vector<const CellRecord*>& cells) {
  const bool is_oracle = std::ranges::any_of(cells, &CellRecord::oracle);
  return method + (is_oracle ? " (oracle)" : "");
}

/// Whether there are results, but all without times.
bool lacks_times(const std::vector<CellRecord>& cells) {
  return std::ranges::none_of(cells, [](const auto& cell) { return cell.runs > 0; }) &&
         std::ranges::any_of(cells, [](const auto& cell) { return has_numbers(cell.status); });
}

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
  std::ranges::copy_if(cells, std::back_inserter(out), [](const CellRecord* cell) {
    return cell->runs > 0 && has_numbers(cell->status);
  });
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
  void add_rows(Table& out, const std::string& method, const std::string& what, Text text) const {
    for (const std::string& name : names_) {
      out.lines.push_back({method, what, name, text(metrics::median(values_.at(name)))});
    }
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::vector<double>> values_;
};

/// One row per phase and count that a method reports: medians over its cells.
Table reported(const std::vector<CellRecord>& cells) {
  Table out{"reported by the methods", {"method", "what", "name", "median"}, {}, {}};
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
  return out;
}

}  // namespace

Table costs(const std::vector<CellRecord>& cells) {
  Table out{"costs",
            {"method",
             "cells",
             "failed",
             "wall [ms]",
             "CPU [ms]",
             "peak memory [MB]",
             "added [MB]",
             "iterations"},
            {},
            {}};
  if (lacks_times(cells)) return out;
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
  return out;
}

std::string costs_html(const ReportContent& content) {
  std::string out;
  for (const Table& listing : {costs(content.cells), reported(content.cells)}) {
    if (!listing.lines.empty()) out += html_table(listing);
  }
  return out.empty() ? "<p>No run times are recorded.</p>\n" : out;
}

}  // namespace loopbench::harness
