#include "harness/commands/history_chart.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/compare/gate_limits.hpp"
#include "harness/report/draw.hpp"

namespace loopbench::harness {
namespace {

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

}  // namespace

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

}  // namespace loopbench::harness
