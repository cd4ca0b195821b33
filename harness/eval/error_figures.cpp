#include "harness/eval/error_figures.hpp"

namespace loopbench::harness {
namespace {

/// Of each of kErrorFigures.
const std::array<std::vector<std::string>, kErrorFigures.size()>& panels() {
  static const std::array<std::vector<std::string>, kErrorFigures.size()> all{
      {{"xy", "xz", "yz", "xyz"},
       {"error by time", "error by distance", "angle by time", "angle by distance", "histogram"},
       {"x by time", "y by time", "z by time", "roll by time", "pitch by time", "yaw by time"}}};
  return all;
}

}  // namespace

FigureData figure_data(const DrawnRuns& runs) {
  FigureData out{"", runs.note, {}, {}};
  if (!runs.drawn.empty()) out.curves.push_back(runs.drawn.front().reference);
  for (const DrawnEvaluation& each : runs.drawn) out.curves.push_back(each.estimate);
  return out;
}

std::vector<DrawnFigure> figures_for_paper(const std::string& prefix, const ErrorFigureSize& size) {
  constexpr double kColumnWidth = 3.5;                  // of a paper [in]
  constexpr double kMapShape = 0.9, kCurveShape = 0.4;  // height over width
  std::vector<DrawnFigure> out;
  for (std::size_t i = 0; i < kErrorFigures.size(); ++i) {
    const bool is_map = i == 0;
    DrawnFigure figure;
    figure.panels = panels()[i];
    figure.columns = size.columns > 0 ? size.columns : (is_map ? 2 : 1);
    figure.width = kColumnWidth / static_cast<double>(figure.columns);
    figure.height = figure.width * (is_map || figure.columns > 1 ? kMapShape : kCurveShape);
    if (size.panel.size() == 2) {
      figure.width = size.panel[0];
      figure.height = size.panel[1];
    }
    figure.font = size.font;
    for (const char* const extension : {".svg", ".pdf", ".png"}) {
      figure.files.emplace_back(prefix + "_" + kErrorFigures[i] + extension);
    }
    out.push_back(std::move(figure));
  }
  return out;
}

std::vector<DrawnFigure> figures_for_page() {
  std::vector<DrawnFigure> out;
  for (std::size_t i = 0; i < kErrorFigures.size(); ++i) {
    const std::size_t columns = panels()[i].size() == 6 ? 3 : 2;
    out.push_back({{}, panels()[i], columns, 4.5, 3.6, 11.0});
  }
  return out;
}

}  // namespace loopbench::harness
