#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/suggest.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/options.hpp"
#include "harness/model/where.hpp"
#include "harness/report/draw.hpp"
#include "harness/report/report.hpp"
#include "harness/tables/store_provenance.hpp"

namespace loopbench::harness {
namespace {

struct PlotArguments {
  std::string store;
  std::string folder;
  std::vector<std::string> formats{"svg", "pdf"};
  std::vector<std::string> methods;
  std::vector<std::string> sequences;
  std::vector<std::string> panels{"plane", "xyz", "x", "y", "z", "angle"};
  FigureOptions figures;
};

/// "se3 alignment" of the first protocol of a sweep, whose trajectories are stored; empty if the
/// store does not state it.
std::string alignment_of(const ReportContent& content) {
  const auto found = content.run.find("protocol");
  const std::string rules = found == content.run.end() ? "" : found->second;
  const std::size_t begin = rules.find("align=", rules.find("]: "));  // after name and changes
  if (begin == std::string::npos) return "";
  const std::string how = rules.substr(begin + 6, rules.find(',', begin) - begin - 6);
  return ", " + (how == "none" ? "no" : how) + " alignment";
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
  reject_standard_output("-o", arguments.folder);
  const std::filesystem::path folder = arguments.folder;
  Traces traces(arguments.store);
  std::vector<FigureData> all;
  std::string written;
  for (std::size_t s = 0; s < content.sequences.size(); ++s) {
    const std::string& sequence = content.sequences[s];
    if (std::ranges::count(sequences, sequence) == 0) continue;
    FigureData data =
        sequence_figure_data(content.cells, traces, sequence, methods, style_order(content));
    if (data.curves.empty()) {
      fmt::print("{}: has no stored trajectories of these methods\n", printable(sequence));
      continue;
    }
    data.title += alignment_of(content);
    for (DrawnCurve& curve : data.curves) {
      const auto place = std::ranges::find(methods, curve.name) - methods.begin();
      if (place < std::ssize(labels)) curve.name = labels[static_cast<std::size_t>(place)];
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
  if (written.empty()) throw InputError(arguments.store + ": has no stored trajectories to plot");
  draw(all);
  fmt::print("{}", printable(written));
  write_result(folder / "provenance.json", json(read_store_provenance(arguments.store)));
  return kExitOk;
}

}  // namespace

void add_plot(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PlotArguments>();
  CLI::App* command = app.add_subcommand("plot", "Plot the trajectories and errors of a sweep");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command->add_option("-o,--out", arguments->folder, "Output folder")
      ->type_name("DIR")
      ->default_val("figures");
  command->add_option("--methods",
                      arguments->methods,
                      "Comma-separated method labels, in \"...\" if a label contains commas "
                      "(default: baseline and best ranked with different results)");
  command->add_option("--sequences",
                      arguments->sequences,
                      "Comma-separated sequence labels, in \"...\" likewise (default: all)");
  command
      ->add_option(
          "--panels",
          arguments->panels,
          "Comma-separated panels: trajectories in the plane of the largest extent (plane), "
          "in xy, xz, yz and in space (xyz), errors in x, y, z and angle")
      ->delimiter(',')
      ->check(CLI::IsMember(panel_names()))
      ->type_name("WORDS")
      ->default_str("plane,xyz,x,y,z,angle");
  command->add_option("--format", arguments->formats, "File formats: svg, pdf, png, pgf or several")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kFigureFormats.begin(), kFigureFormats.end())))
      ->default_str("svg,pdf");
  declare_figures(*command, arguments->figures);
  command->callback([arguments, &exit_code] { exit_code = write_figures(*arguments); });
}

}  // namespace loopbench::harness
