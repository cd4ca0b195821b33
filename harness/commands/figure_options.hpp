/// Options of figures that `plot`, `traj plot` and `eval --plot` share.
#pragma once

namespace CLI {
class App;
}

#include <CLI/CLI.hpp>
#include <string>

#include "harness/report/draw.hpp"

namespace loopbench::harness {

/// `needs`: option without which those of the files have no effect; empty: none.
inline void declare_figure_options(CLI::App& command,
                                   FigureOptions& options,
                                   const std::string& needs) {
  command
      .add_option("--labels",
                  options.labels,
                  "Comma-separated names of the estimates in the legend, in their order")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      .add_option(
          "--plane", options.plane, "Plane of the map: xy, xz or yz; default: the largest extent")
      ->check(CLI::IsMember({"xy", "xz", "yz"}))
      ->type_name("WORD");
  const std::vector<CLI::Option*> of_files{
      command
          .add_option("--style",
                      options.style,
                      "Comma-separated style sheets of matplotlib, files or names, for fonts, "
                      "colours and lines")
          ->delimiter(',')
          ->type_name("FILE_OR_NAME"),
      command
          .add_option("--size",
                      options.size,
                      "Width and height of a panel [in]; default: 3.5,2.8; of eval 3.5 in divided "
                      "by the columns")
          ->delimiter(',')
          ->check(CLI::Range(0.5, 50.0))
          ->type_name("WIDTH,HEIGHT"),
      command
          .add_option(
              "--font", options.font, "Font size [pt]; default: that of --style, 8, or 7 of eval")
          ->check(CLI::Range(2.0, 100.0))
          ->type_name("PT"),
      command
          .add_option("--panel-columns",
                      options.columns,
                      "Panels in a row; default: 2; of traj plot 3; of curves of eval 1")
          ->check(CLI::Range(1, 10))
          ->type_name("N"),
      command.add_flag(
          "--script",
          options.script,
          "Also write each figure's data (.json) and the Python script (.py) that draws them")};
  for (CLI::Option* const option : of_files) {
    if (!needs.empty()) option->needs(needs);
  }
}

}  // namespace loopbench::harness
