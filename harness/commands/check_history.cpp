#include "harness/commands/check_history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/compare/baseline_file.hpp"
#include "harness/compare/gate_limits.hpp"
#include "harness/compare/snapshot.hpp"
#include "harness/report/draw.hpp"
#include "harness/tables/gate_table.hpp"

namespace loopbench::harness {
namespace {

struct StoredBaseline {
  std::string file;
  Baseline baseline;
};

/// The values of one score by method and run.
using MethodValues = std::map<std::string, std::map<std::string, double>>;

/// The score and the statistic of a chart.
struct ChartedScore {
  GateScore score;
  std::string statistic;
};

ChartedScore charted_score(const StoredBaseline& first, const std::vector<std::string>& filters) {
  const auto keeps = where(filters);
  const auto limit = limit_of(first.baseline.limits);
  for (const GateCell& cell : first.baseline.snapshot.cells) {
    for (const GateScore& score : cell.scores) {
      const Tolerance* const own = limit(score);
      if (own != nullptr && keeps(score)) return {score, own->values.front()};
    }
  }
  throw InputError(fmt::format(
      "{}: --where '{}' selects no score with a limit", first.file, fmt::join(filters, ", ")));
}

MethodValues values_of(const Baseline& baseline,
                       const ChartedScore& charted,
                       const std::vector<std::string>& filters) {
  MethodValues out;
  const auto keeps = where(filters);
  for (const GateCell& cell : baseline.snapshot.cells) {
    for (const GateScore& score : cell.scores) {
      if (name(score) != name(charted.score) || !keeps(score)) continue;
      const auto value = score.values.find(charted.statistic);
      if (value == score.values.end() || !std::isfinite(value->second)) continue;
      out[cell.method][run_name(cell)] = value->second;
    }
  }
  return out;
}

/// The ratio of the means over the runs of both; none without such runs, or if the first mean is 0.
std::optional<double> relative(const std::map<std::string, double>& now,
                               const std::map<std::string, double>& first) {
  double sum = 0.0, base = 0.0;
  for (const auto& [run, value] : first) {
    const auto found = now.find(run);
    if (found == now.end()) continue;
    sum += found->second;
    base += value;
  }
  return base == 0.0 ? std::nullopt : std::optional(sum / base);
}

/// "a.json (0.3.0, 71e77bd962c0)": version and commit of its build; a baseline states no date.
std::string described(const StoredBaseline& stored) {
  const auto& summary = stored.baseline.build_summary;
  const auto stated = [&](const char* key) {
    const auto found = summary.find(key);
    return found == summary.end() ? std::string("unknown") : found->second;
  };
  return fmt::format("{} ({}, {}{})",
                     stored.file,
                     stated("loopbench"),
                     stated("commit").substr(0, 12),
                     is_dirty(summary) ? ", dirty" : "");
}

/// Draws the first score that `filters` select, with its first limited statistic: for each method
/// its mean over the runs that both files have, divided by that of the first file with the method.
/// Methods that changed most come first, because long legends are cut. Throws InputError if no
/// score with a limit is selected.
void draw_history(const std::vector<StoredBaseline>& all,
                  const std::filesystem::path& file,
                  const std::vector<std::string>& filters) {
  const ChartedScore charted = charted_score(all.front(), filters);
  FigureData data{.title = fmt::format("{}: {}, {}, relative to the first baseline",
                                       all.front().baseline.snapshot.sweep,
                                       name(charted.score),
                                       charted.statistic)};
  MethodValues first;
  std::map<std::string, DrawnCurve> curves;
  for (std::size_t i = 0; i < all.size(); ++i) {
    data.note += fmt::format("{}{}: {}", i == 0 ? "" : "; ", i + 1, described(all[i]));
    for (const auto& [method, values] : values_of(all[i].baseline, charted, filters)) {
      const auto base = first.try_emplace(method, values).first;
      const std::optional<double> ratio = relative(values, base->second);
      if (!ratio) continue;
      DrawnCurve& curve = curves[method];
      curve.columns["baseline"].push_back(static_cast<double>(i + 1));
      curve.columns["relative"].push_back(*ratio);
    }
  }
  const auto change = [](const DrawnCurve& curve) {
    double out = 0.0;
    for (const double ratio : curve.columns.at("relative")) {
      out = std::max(out, std::abs(ratio - 1.0));
    }
    return out;
  };
  for (auto& [method, curve] : curves) {
    curve.name = method;
    data.curves.push_back(std::move(curve));
  }
  std::ranges::stable_sort(data.curves, std::greater<>(), change);  // long legends are cut
  for (std::size_t i = 0; i < data.curves.size(); ++i) data.curves[i].style = i;
  FigureOptions look;
  look.size = {6.5, 4.0};
  data.figures.push_back({{file}, {"relative by baseline"}, look});
  draw({data});
  fmt::print("{}\n", printable(file.string()));
}

/// "changed: dual (2 cells), motion_drift (40 cells)", or empty without findings in cells.
std::string changed_methods(const GateReport& report,
                            const StoredBaseline& before,
                            const StoredBaseline& now) {
  std::map<std::string, std::string> method_of;  // by name of the cell
  for (const StoredBaseline* const each : {&before, &now}) {
    for (const GateCell& cell : each->baseline.snapshot.cells) method_of[name(cell)] = cell.method;
  }
  std::map<std::string, std::set<std::string>> cells;
  for (const Finding& finding : report.findings) {
    const auto method = method_of.find(finding.cell);
    if (method != method_of.end()) cells[method->second].insert(finding.cell);
  }
  std::string out;
  for (const auto& [method, changed] : cells) {
    out += fmt::format("{}{} ({})",
                       out.empty() ? "changed: " : ", ",
                       method,
                       counted_findings(changed.size(), "cell"));
  }
  return out;
}

/// Whether something changed.
bool print_step(const StoredBaseline& before, const StoredBaseline& now) {
  GateReport report;
  std::vector<std::string> first_notes =
      different_definitions(before.baseline.snapshot, now.baseline.snapshot);
  try {
    report = changes(before.baseline, now.baseline.snapshot);
  } catch (const InputError& error) {
    first_notes.push_back(std::string("values are not compared: ") + error.what());
  }
  const std::string title = described(before) + " -> " + described(now);
  if (first_notes.empty() && report.findings.empty()) {
    fmt::print("### {}\n\n- no change\n\n", one_line(title));
    return false;
  }
  if (const std::string changed = changed_methods(report, before, now); !changed.empty()) {
    first_notes.push_back(changed);
  }
  report.notes.insert(report.notes.begin(), first_notes.begin(), first_notes.end());
  fmt::print("{}\n", findings_markdown(report, title));
  return true;
}

}  // namespace

void check_history(const HistoryOptions& options) {
  if (options.files.size() < 2) throw InputError("--history: expected at least two baselines");
  if (!options.chart.empty() && !is_figure_name(options.chart)) {
    throw InputError(fmt::format("--chart: {}: expected a name that ends in {}",
                                 options.chart.string(),
                                 fmt::join(kFigureFormats, ", ")));
  }
  reject_overwriting(options.files, options.chart);
  std::vector<StoredBaseline> all;
  for (const std::filesystem::path& file : options.files) {
    all.push_back({file.string(), read_earlier_baseline(file)});
  }
  std::size_t changed = 0;
  for (std::size_t i = 1; i < all.size(); ++i) changed += print_step(all[i - 1], all[i]) ? 1 : 0;
  const std::size_t steps = all.size() - 1;
  fmt::print("{} baselines: {}\n",
             all.size(),
             changed == 0 ? "nothing changed"
                          : fmt::format("{} of {} steps with changes", changed, steps));
  if (!options.chart.empty()) draw_history(all, options.chart, options.where);
}

}  // namespace loopbench::harness
