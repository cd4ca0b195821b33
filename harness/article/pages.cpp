#include "harness/article/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "harness/article/heat_map.hpp"
#include "harness/article/ledger.hpp"
#include "harness/article/paper_figures.hpp"
#include "harness/article/paper_tables.hpp"
#include "harness/article/run_pages.hpp"
#include "harness/article/schematic_figures.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

bool is_tables(const PaperConfig& config) {
  return config.sweep.baseline == "ORB_SLAM2" &&
         std::ranges::any_of(config.cells, [](const PaperCell& c) {
           return !c.reading.empty() && !c.variant.empty();
         });
}

/// Text of the `description: >` block that the config begins with.
std::string config_description(const std::string& config) {
  std::istringstream in(config);
  std::string line, out;
  std::getline(in, line);
  while (std::getline(in, line) && line.starts_with("  ")) out += line.substr(2) + "\n";
  return out;
}

std::optional<double> swept(const Sweep& sweep, const PaperCell& cell, const char* option) {
  const MethodChoice& method = sweep.methods[cell.result.cell.method];
  for (const Choice& stage : method.stages) {
    const auto it = stage.options.find(option);
    if (it == stage.options.end()) continue;
    if (const double* value = std::get_if<double>(&it->second)) return *value;
    if (const auto* value = std::get_if<std::int64_t>(&it->second))
      return static_cast<double>(*value);
  }
  return std::nullopt;
}

bool is_threshold_sweep(const PaperConfig& config) {
  std::size_t count = 0;
  for (const PaperCell& cell : config.cells) {
    if (config.sweep.methods[cell.result.cell.method].label == config.sweep.baseline) continue;
    if (!swept(config.sweep, cell, "speed_band") || !swept(config.sweep, cell, "turn_max"))
      return false;
    ++count;
  }
  return count > 4;
}

/// Gain over the baseline in dense 3-D ATE [%], one map per dataset.
std::vector<HeatMap> threshold_maps(const PaperConfig& config) {
  std::vector<HeatMap> out;
  for (std::size_t d = 0; d < config.sweep.datasets.size(); ++d) {
    std::map<double, std::map<double, double>> ates;  // band, threshold
    double raw = std::numeric_limits<double>::quiet_NaN();
    for (const PaperCell& cell : config.cells) {
      if (cell.result.cell.dataset != d) continue;
      const double ate =
          ate_3d(cell, metrics::Times::dense).value_or(std::numeric_limits<double>::quiet_NaN());
      if (config.sweep.methods[cell.result.cell.method].label == config.sweep.baseline) {
        raw = ate;
      } else {
        ates[swept(config.sweep, cell, "speed_band").value_or(0.0)]
            [swept(config.sweep, cell, "turn_max").value_or(0.0)] = ate;
      }
    }
    HeatMap map;
    map.title = config.sweep.datasets[d].label + ": gain in dense 3-D ATE over the polyline [%]";
    map.row_title = "band [m/s]";
    map.column_title = "curvature threshold [rad per keyframe]";
    for (const auto& [band, row] : ates) {
      map.rows.push_back(fmt::format("{}", band));
      map.columns.clear();
      map.values.emplace_back();
      for (const auto& [threshold, ate] : row) {
        map.columns.push_back(fmt::format("{}", threshold));
        map.values.back().push_back(100.0 * (1.0 - ate / raw));
      }
    }
    out.push_back(std::move(map));
  }
  return out;
}

std::string page_name(const Sweep& sweep) {
  const std::string prefix = "paper_tables_";
  return sweep.name.starts_with(prefix) ? sweep.name.substr(prefix.size()) : sweep.name;
}

}  // namespace

bool needs_dense(const PaperCell& cell) {
  if (cell.is_baseline()) return true;
  return cell.reading == "text" || cell.reading == "guarded" || cell.reading == kNaturalSpline;
}

std::vector<std::filesystem::path> write_pages(const std::vector<PaperConfig>& configs,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> written;
  const auto page = [&](const std::string& name, const std::string& text) {
    write_result(folder / name, text);
    written.push_back(folder / name);
  };
  std::vector<PaperCell> pooled;
  std::string sources;
  for (const PaperConfig& config : configs) {
    if (!is_tables(config)) continue;
    sources += " " + config.sweep.name + ".yaml";
    pooled.insert(pooled.end(), config.cells.begin(), config.cells.end());
  }
  if (!pooled.empty()) {
    page("tables.md",
         "# Tables 1 to 4\n\nErrors along one axis of the reference at the keyframes of the closed "
         "run, after a rigid fit; RPE over one keyframe; densely: at the stamps of the reference. "
         "The readings are explained in [README](README.md).\n\nFrom" +
             sources + ".\n" + paper_tables(pooled));
    page("ledger.md",
         "# The article, statement by statement\n\nFrom" + sources + ".\n\n" + ledger(pooled));
    std::string figures =
        "# Figures 1 to 8\n\nTruth red and thickest, ORB-SLAM2 green, ours blue and thinnest; "
        "curves are "
        "cut 0.3 m outside the reference. `text` is fitted in the reference's axes, `guarded` in "
        "axes "
        "along the chord of each window; all curves are drawn in the alignment of the raw run. "
        "Coefficients are those of y = +f(x), in the article's "
        "order "
        "and with its alpha(0,1) = 1.\n";
    for (const PaperFigure& figure : schematic_figures(pooled, folder)) {
      written.push_back(folder / figure.file);
      figures += fmt::format("\n![{0}]({0})\n\n{1}", figure.file, figure.caption);
    }
    for (const char* reading : {"text", "guarded"}) {
      figures += fmt::format("\n## Reading `{}`\n", reading);
      for (const PaperFigure& figure : paper_figures(pooled, reading, folder / reading)) {
        written.push_back(folder / reading / figure.file);
        figures +=
            fmt::format("\n![{0}]({0})\n\n{1}", reading + ("/" + figure.file), figure.caption);
      }
    }
    page("figures.md", figures);
  }
  for (const PaperConfig& config : configs) {
    if (is_tables(config)) continue;
    const Sweep& sweep = config.sweep;
    const std::string name = page_name(sweep);
    std::string title = name;
    std::ranges::replace(title, '_', ' ');
    title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
    std::string text = fmt::format(
        "# {}\n\n{}\nFrom {}.yaml.\n", title, config_description(sweep.text), sweep.name);
    if (is_threshold_sweep(config)) {
      const std::vector<HeatMap> maps = threshold_maps(config);
      write_heat_maps(folder / (name + ".svg"), maps);
      written.push_back(folder / (name + ".svg"));
      text += fmt::format("\n![{0}]({0}.svg)\n", name);
      for (const HeatMap& map : maps) text += "\n## " + map.title + "\n" + heat_table(map);
    } else if (sweep.table.rows == std::vector<std::string>{"sequence"}) {
      gain_figure(config.cells, sweep.baseline, folder / (name + ".svg"));
      written.push_back(folder / (name + ".svg"));
      text += fmt::format("\n![{0}]({0}.svg)\n", name) + gain_matrix(config.cells, sweep.baseline);
    } else {
      text += method_tables(config.cells, sweep.baseline);
    }
    page(name + ".md", text);
  }
  return written;
}

}  // namespace loopbench::harness
