#include <fmt/format.h>

#include <algorithm>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/report/sections.hpp"
#include "harness/answers/tables/growth.hpp"
#include "harness/sweep/catalogue/exchange.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

struct CellsOfMethod {
  std::string name;  ///< as in other tables
  std::vector<const CellRow*> all;
  std::vector<const CellRow*> timed;  ///< with results and run times
};

/// In order of first appearance.
std::vector<CellsOfMethod> by_method(const std::vector<CellRow>& cells) {
  NameOrder methods;
  std::vector<CellsOfMethod> out;
  for (const CellRow& cell : cells) {
    const std::size_t index = methods.index(cell.method);
    if (index == out.size()) out.push_back({cell.method, {}, {}});
    if (cell.oracle) out[index].name = cell.method.text() + " (oracle)";
    out[index].all.push_back(&cell);
    if (cell.runs > 0 && has_numbers(cell.status)) out[index].timed.push_back(&cell);
  }
  return out;
}

/// The values that the cells have.
template <class Get>
std::vector<double> values_of(const std::vector<const CellRow*>& cells, Get get) {
  std::vector<double> out;
  for (const CellRow* cell : cells) {
    if (const auto value = get(*cell)) out.push_back(static_cast<double>(*value));
  }
  return out;
}

/// The median, times `unit`.
std::string median_text(const std::vector<double>& values, double unit, const char* format) {
  return values.empty() ? "-" : fmt::format(fmt::runtime(format), unit * metrics::median(values));
}

std::string milliseconds(const std::vector<double>& seconds) {
  return median_text(seconds, 1e3, "{:.4g}");
}

std::string median_count(const std::vector<double>& counts) {
  return median_text(counts, 1.0, "{:.6g}");
}

/// With the wall time beside a time that programs state.
std::string time_text(const std::vector<const CellRow*>& cells) {
  const std::string time =
      milliseconds(values_of(cells, [](const auto& c) { return std::optional(c.seconds); }));
  const std::vector<double> wall = values_of(cells, [](const CellRow& cell) {
    const auto found = std::ranges::find(cell.phases, kWallPhase, &methods::Phase::name);
    return found == cell.phases.end() ? std::nullopt : std::optional(found->seconds);
  });
  return wall.empty() ? time : time + kStatedMark + ", wall " + milliseconds(wall);
}

std::string megabytes(const std::vector<double>& bytes) {
  return bytes.empty() ? "-" : fmt::format("{:.1f}", 1e-6 * std::ranges::max(bytes));
}

std::optional<double> iterations(const CellRow& cell) {
  const auto found = std::ranges::find(cell.counts, "iterations", &methods::Count::name);
  return found == cell.counts.end() ? std::nullopt : std::optional(found->value);
}

/// One row per phase and count that a method reports: medians over its cells.
Table reported(const std::vector<CellRow>& cells) {
  Table out{"reported by the methods", {"method", "what", "name", "median"}, {}, {}};
  for (const CellsOfMethod& method : by_method(cells)) {
    const auto add = [&](const char* what, auto list, auto value, auto text) {
      NameOrder names;
      std::vector<std::vector<double>> values;
      for (const CellRow* cell : method.timed) {
        for (const auto& item : cell->*list) {
          const std::size_t index = names.index(item.name);
          values.resize(names.names().size());
          values[index].push_back(item.*value);
        }
      }
      for (std::size_t i = 0; i < values.size(); ++i) {
        out.lines.push_back({method.name, what, names.names()[i], text(values[i])});
      }
    };
    add("phase [ms]", &CellRow::phases, &methods::Phase::seconds, milliseconds);
    add("count", &CellRow::counts, &methods::Count::value, median_count);
  }
  return out;
}

}  // namespace

Table costs(const std::vector<CellRow>& cells) {
  Table out{"costs",
            {"method",
             "cells",
             "failed",
             "time [ms]",
             "CPU [ms]",
             "least CPU [ms]",
             "CPU variation [%]",
             "runs",
             "peak memory [MB]",
             "added [MB]",
             "iterations"},
            {},
            {"medians over cells; time: wall time from the problem to the result, or (s) as the "
             "program states it; variation: standard deviation by mean over the runs of a cell; "
             "memory: the largest resident size of the process while the "
             "method ran, and its increase (memory that an earlier cell returned to the allocator "
             "is reused without being counted). CPU and memory of a program are its own"}};
  const bool has_times = std::ranges::any_of(cells, [](const auto& cell) { return cell.runs > 0; });
  const bool has_results =
      std::ranges::any_of(cells, [](const auto& cell) { return has_numbers(cell.status); });
  if (has_results && !has_times) return out;
  for (const CellsOfMethod& method : by_method(cells)) {
    const auto failed = std::ranges::count_if(method.all, [](const CellRow* cell) {
      return !has_numbers(cell->status) && cell->status != Status::declined;
    });
    const auto values = [&](const auto& get) { return values_of(method.timed, get); };
    const std::vector<double> least = values([](const auto& c) { return c.cpu_seconds_min; });
    out.lines.push_back(
        {method.name,
         std::to_string(method.all.size()),
         std::to_string(failed),
         time_text(method.timed),
         milliseconds(values([](const auto& c) { return c.cpu_seconds; })),
         least.empty() ? "-" : fmt::format("{:.4g}", 1e3 * std::ranges::min(least)),
         median_text(values([](const auto& c) { return c.cpu_variation; }), 100.0, "{:.1f}"),
         median_count(values([](const auto& c) { return std::optional(c.runs); })),
         megabytes(values([](const auto& c) { return c.peak_memory; })),
         megabytes(values([](const auto& c) { return c.added_memory; })),
         median_count(values(iterations))});
  }
  constexpr double kBusy = 0.1;  // share of the time
  const auto busy = std::ranges::count_if(
      cells, [](const auto& cell) { return cell.waiting.value_or(0.0) > kBusy; });
  if (busy > 0) {
    out.notes.push_back(fmt::format(
        "busy machine: {} of {} cells waited for a processor for more than {:.0f} % of their wall "
        "time, so compare processor times",
        busy,
        cells.size(),
        100.0 * kBusy));
  }
  const auto alone = std::ranges::count(cells, true, &CellRow::serial);
  if (alone < std::ssize(cells)) {
    out.notes.push_back(
        std::string(alone > 0 ? "some" : "all") +
        " cells ran in parallel with others; `timing: true` in the config runs them one at a time");
  }
  return out;
}

std::string costs_html(const ReportContent& content) {
  std::string out;
  for (const Table& listing :
       {costs(content.cells), growth_table(content.cells), reported(content.cells)}) {
    if (!listing.lines.empty()) out += html_table(listing);
  }
  return out.empty() ? "<p>No run times are recorded.</p>\n" : out;
}

}  // namespace loopbench::harness
