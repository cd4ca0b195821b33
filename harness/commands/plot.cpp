#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/core/error.hpp"
#include "harness/answers/report/alignment_text.hpp"
#include "harness/answers/report/data.hpp"
#include "harness/answers/report/draw.hpp"
#include "harness/answers/report/report.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "harness/answers/tables/growth.hpp"
#include "harness/answers/tables/store_provenance.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/options.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

struct PlotArguments {
  std::string store;
  std::string folder;
  std::vector<std::string> formats{"pdf"};
  std::vector<std::string> methods;
  std::vector<std::string> sequences;
  std::vector<std::string> panels{
      "plane", "xyz", "x", "y", "z", "angle", "ratio", "time", "boxes", "growth"};
  FigureOptions figures;
};

/// ", not aligned" of the first protocol of a sweep, whose trajectories are stored; empty if the
/// store does not state it.
std::string alignment_of(const ReportContent& content) {
  const auto all = alignments(content.run);
  return all.empty() ? "" : ", " + alignment_text(all.front().second);
}

/// Whether the store has what a panel of scores shows.
bool has_data(const ReportContent& content, const std::string& panel) {
  if (panel == "ratio") return content.headline() != nullptr;
  if (panel == "growth") return !growths(content.cells).empty();
  if (panel == "time") return std::ranges::any_of(content.cells, &CellRow::runs);
  return !content.records.empty();
}

/// Figures of all sequences, one for each panel that the store has data for.
FigureData score_figures(const ReportContent& content,
                         const PlotArguments& arguments,
                         const std::map<std::string, std::string>& names) {
  FigureData out;
  for (const std::string& panel : arguments.panels) {
    if (std::ranges::count(kScorePanels, panel) == 0 || !has_data(content, panel)) continue;
    out.figures.push_back({{}, {panel}, arguments.figures});
    for (const std::string& format : arguments.formats) {
      out.figures.back().files.push_back(arguments.folder + "/" + panel + "." + format);
    }
  }
  const nlohmann::json data{{"scores", scores_json(content)},
                            {"comparisons", nlohmann::json::parse(json(content.comparisons))},
                            {"names", names}};
  out.scores = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return out;
}

/// Each word is a label or comma-separated labels; a label can contain commas itself.
std::vector<std::string> known_labels(const std::string& kind,
                                      const std::vector<std::string>& words,
                                      const std::vector<std::string>& known) {
  std::vector<std::string> out;
  for (const std::string& word : words) {
    const bool is_label = std::ranges::count(known, word) > 0;
    for (const std::string& name : is_label ? std::vector{word} : split_list(word)) {
      if (std::ranges::count(known, name) == 0) {
        throw InputError("--" + kind + "s: " + unknown_name(kind, name, known));
      }
      out.push_back(name);
    }
  }
  return out;
}

std::vector<OutputFile> figure_outputs(const std::vector<FigureData>& all,
                                       const std::filesystem::path& folder) {
  std::vector<OutputFile> out{{"--out", folder / "provenance.json", FileKind::printed, true}};
  for (const FigureData& data : all) {
    for (const DrawnFigure& figure : data.figures) {
      for (const std::filesystem::path& file : figure.files)
        out.push_back({"--out", file, FileKind::figure});
    }
  }
  return out;
}

int write_figures(const PlotArguments& arguments) {
  const ReportContent content = read_report_content(arguments.store);
  const std::vector<std::string> methods =
      arguments.methods.empty() ? default_methods(content)
                                : known_labels("method", arguments.methods, content.methods);
  const std::vector<std::string> sequences =
      arguments.sequences.empty()
          ? content.sequences
          : known_labels("sequence", arguments.sequences, content.sequences);
  const std::vector<std::string> labels = labels_of(arguments.figures, methods);
  std::map<std::string, std::string> names;  // of the drawn methods
  for (std::size_t i = 0; i < methods.size(); ++i) names[methods[i]] = labels[i];
  const bool draws_paths = std::ranges::any_of(
      arguments.panels, [](const auto& p) { return std::ranges::count(kScorePanels, p) == 0; });
  reject_standard_output("-o", arguments.folder);
  const std::filesystem::path folder = arguments.folder;
  Traces traces(arguments.store);
  std::vector<FigureData> all;
  std::string written;
  for (std::size_t s = 0; s < content.sequences.size(); ++s) {
    const std::string& sequence = content.sequences[s];
    if (!draws_paths || std::ranges::count(sequences, sequence) == 0) continue;
    FigureData data =
        sequence_figure_data(content.cells, traces, sequence, methods, style_order(content));
    if (data.curves.empty()) {
      fmt::print("{}: has no stored trajectories of these methods\n", printable(sequence));
      continue;
    }
    data.title += alignment_of(content);
    for (DrawnCurve& curve : data.curves) {
      if (names.contains(curve.name)) curve.name = names[curve.name];
    }
    // The index separates labels that map to the same file name.
    const std::string stem = fmt::format("{:02}_{}", s + 1, file_stem(sequence));
    for (const bool of_errors : {false, true}) {
      DrawnFigure figure{{}, figure_panels(arguments.panels, of_errors), arguments.figures};
      if (figure.panels.empty()) continue;
      for (const std::string& format : arguments.formats) {
        const char* const what = of_errors ? "_errors." : "_trajectories.";
        figure.files.push_back(folder / (stem + what + format));
      }
      written += file_list(figure);
      data.figures.push_back(std::move(figure));
    }
    all.push_back(std::move(data));
  }
  if (arguments.methods.empty()) {
    for (const std::string& method : content.methods) names.emplace(method, method);
  }
  all.push_back(score_figures(content, arguments, names));
  for (const DrawnFigure& figure : all.back().figures) written += file_list(figure);
  if (written.empty()) throw InputError(arguments.store + ": has no stored trajectories to plot");
  require_writable(figure_outputs(all, folder));
  draw(all);
  fmt::print("{}", printable(written));
  write_result(folder / "provenance.json", json(read_store_provenance(arguments.store)));
  return kExitOk;
}

}  // namespace

void add_plot(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PlotArguments>();
  PlotArguments& a = *arguments;
  CLI::App& command =
      *app.add_subcommand("plot", "Plot trajectories, errors, scores and costs of a sweep");
  declare_store(command, a.store);
  add(command, "-o,--out DIR", a.folder, "Output folder")->default_val("figures");
  add(command,
      "--methods",
      a.methods,
      "Comma-separated method labels, in \"...\" if a label contains commas (default: baseline, "
      "best, "
      "best without a smoother; all for scores)");
  add(command,
      "--sequences",
      a.sequences,
      "Comma-separated sequence labels, in \"...\" likewise (default: all)");
  add(command,
      "--panels WORDS",
      a.panels,
      "Comma-separated panels: trajectories in the plane of the largest extent (plane), in xy, xz, "
      "yz and in space (xyz), errors in x, y, z and angle; of all sequences ratios to the baseline "
      "(ratio), error against time (time), runs (boxes), time and memory over a swept size "
      "(growth)")
      ->delimiter(',')
      ->check(CLI::IsMember(panel_names()))
      ->default_str("plane,xyz,x,y,z,angle,ratio,time,boxes,growth");
  add(command, "--format", a.formats, "File formats: svg, pdf, png, pgf or several")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kFigureFormats.begin(), kFigureFormats.end())))
      ->default_str("pdf");
  declare_figures(command, a.figures);
  declare_force(command);
  command.callback([arguments, &exit_code] { exit_code = write_figures(*arguments); });
}

}  // namespace loopbench::harness
