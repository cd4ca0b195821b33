#include "harness/answers/report/map_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "harness/answers/report/sections.hpp"

namespace loopbench::harness {
namespace {

constexpr double kMapWidth = 620.0, kMapLeft = 58.0, kMapMargin = 12.0, kMapBottom = 40.0;  // [px]
constexpr std::array kMapAxes{"x", "y", "z"};

struct MapRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double size() const { return high - low; }
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// With a margin; at least `least` wide, around the same middle.
  MapRange wider(double least) const {
    const double half = std::max(0.54 * size(), 0.5 * least), middle = 0.5 * (low + high);
    return {middle - half, middle + half};
  }
};

const std::vector<double>& map_column(const DrawnCurve& curve, std::size_t axis) {
  return curve.columns.at(kMapAxes[axis]);
}

/// 1, 2 or 5 times a power of ten, so that about five fit.
double tick_step(double size) {
  const double power = std::pow(10.0, std::floor(std::log10(size / 5.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= size / 6.0) return factor * power;
  }
  return 10.0 * power;
}

/// The frame of a map: metres to pixels in two axes.
struct MapFrame {
  std::size_t a = 0, b = 1;  ///< axes to the right, and up
  MapRange right, up;
  double scale = 1.0;  ///< [px/m]

  explicit MapFrame(const std::vector<DrawnCurve>& curves) {
    std::array<MapRange, 3> range;
    for (const DrawnCurve& curve : curves) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double value : map_column(curve, axis)) range[axis].add(value);
      }
    }
    for (MapRange& each : range) {
      if (!(each.low <= each.high)) each = {0.0, 0.0};
    }
    const std::array size{range[0].size(), range[1].size(), range[2].size()};
    const auto normal = static_cast<std::size_t>(
        2 - (std::min_element(size.rbegin(), size.rend()) - size.rbegin()));
    a = normal == 0 ? 1 : 0;
    b = normal == 2 ? 1 : 2;
    const double most = std::max({size[a], size[b], 1e-6});
    right = range[a].wider(0.6 * most);
    up = range[b].wider(0.4 * most);
    scale = (kMapWidth - kMapLeft - kMapMargin) / right.size();
  }

  double height() const { return scale * up.size() + kMapMargin + kMapBottom; }
  double x(double value) const { return kMapLeft + scale * (value - right.low); }
  double y(double value) const { return kMapMargin + scale * (up.high - value); }
};

std::string map_path(const DrawnCurve& curve, const MapFrame& frame) {
  const std::vector<double>&x = map_column(curve, frame.a), &y = map_column(curve, frame.b);
  std::string out;
  bool is_begun = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      is_begun = false;
      continue;
    }
    out += fmt::format("{}{:.1f},{:.1f}", is_begun ? 'L' : 'M', frame.x(x[i]), frame.y(y[i]));
    is_begun = true;
  }
  return out;
}

std::string map_ticks(const MapFrame& frame) {
  std::string out = "<g class=\"grid\">", texts;
  const double left = kMapLeft, end = kMapWidth - kMapMargin;
  const double top = kMapMargin, bottom = frame.height() - kMapBottom;
  const auto line = [&](double x1, double y1, double x2, double y2) {
    out += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", x1, y1, x2, y2);
  };
  const auto text = [&](double x, double y, const char* anchor, const std::string& what) {
    texts += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, what);
  };
  const double step = tick_step(std::max(frame.right.size(), frame.up.size()));
  const auto label = [&](double value) { return fmt::format("{:.6g}", step * value + 0.0); };
  for (double k = std::ceil(frame.right.low / step); k * step <= frame.right.high; ++k) {
    line(frame.x(k * step), top, frame.x(k * step), bottom);
    text(frame.x(k * step), bottom + 16.0, "middle", label(k));
  }
  for (double k = std::ceil(frame.up.low / step); k * step <= frame.up.high; ++k) {
    line(left, frame.y(k * step), end, frame.y(k * step));
    text(left - 6.0, frame.y(k * step) + 4.0, "end", label(k));
  }
  text(0.5 * (left + end), bottom + 33.0, "middle", fmt::format("{} [m]", kMapAxes[frame.a]));
  text(4.0, top + 10.0, "start", fmt::format("{} [m]", kMapAxes[frame.b]));
  return out + "</g>" + texts +
         fmt::format(
             "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
             "height=\"{:.1f}\"/>",
             left,
             top,
             end - left,
             bottom - top);
}

/// Attributes of a curve's strokes; the first has the colour of the text.
std::string map_stroke(const DrawnCurve& curve, bool is_first) {
  if (is_first) return "class=\"loop\"";
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                     curve_style(curve.style).color,
                     curve.is_thin ? 1.3 : 3.5);
}

}  // namespace

std::string map_figure(const FigureData& data) {
  const MapFrame frame(data.curves);
  std::string paths, legend;
  for (const DrawnCurve& curve : data.curves) {
    const std::string stroke = map_stroke(curve, &curve == &data.curves.front());
    paths += fmt::format("<path {} d=\"{}\"><title>{}</title></path>\n",
                         stroke,
                         map_path(curve, frame),
                         html_text(curve.name));
    legend += fmt::format(
        "<span><svg width=\"22\" height=\"8\" viewBox=\"0 0 22 8\"><path {} d=\"M0,4L22,4\"/></svg>"
        "{}</span>\n",
        stroke,
        html_text(curve.name));
  }
  return fmt::format(
      "<figure><figcaption>{}<small>{}</small></figcaption>\n<svg viewBox=\"0 0 {} {:.1f}\" "
      "role=\"img\" aria-label=\"{}\">{}\n{}</svg>\n<div class=\"legend\">{}</div></figure>\n",
      html_text(data.title),
      html_text(data.note),
      kMapWidth,
      frame.height(),
      html_text(data.title),
      map_ticks(frame),
      paths,
      legend);
}

}  // namespace loopbench::harness
