#include "harness/plot/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace loopbench::harness {
namespace {

/// Range of an axis. gnuplot warns about empty ranges (planar paths, errors across the plane), so
/// these are widened to `least` or a tenth of the number.
std::string axis_range(const char* axis,
                       const std::vector<PlotSeries>& series,
                       Eigen::Index coordinate,
                       double least,
                       const char* mode = "") {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotSeries& each : series) {
    for (const Vector3& p : each.points) {
      if (!p.allFinite()) continue;
      low = std::min(low, p(coordinate));
      high = std::max(high, p(coordinate));
    }
  }
  const double pad = std::max(least, 0.1 * std::abs(low));
  if (low > high || high - low > 1e-9 * pad) {
    return fmt::format("set {}range [*:*]{}\n", axis, mode);
  }
  return fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis, low - pad, high + pad);
}

/// Lower and upper bound of the finite coordinates; empty without any.
std::optional<std::pair<double, double>> bounds(const PlotPanel& panel, Eigen::Index coordinate) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotSeries& series : panel.series) {
    for (const Vector3& p : series.points) {
      if (!p.allFinite()) continue;
      low = std::min(low, p(coordinate));
      high = std::max(high, p(coordinate));
    }
  }
  if (low > high) return std::nullopt;
  return std::pair{low, high};
}

/// The largest of 1, 2 and 5 times a power of ten that is at most `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= step) return factor * power;
  }
  return power;
}

/// Equal scales on both axes of a map in a frame of this size [in].
std::string equal_scales(const PlotPanel& panel, double width, double height) {
  constexpr double kSpace = 1.08;
  constexpr double kLeastLength = 1e-6;  // [m]
  std::array<double, 2> middle{0.0, 0.0};
  double scale = 0.0;  // [m/in]
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto range = bounds(panel, static_cast<Eigen::Index>(axis));
    if (!range) return "";
    middle[axis] = 0.5 * (range->first + range->second);
    const double size = axis == 0 ? width : height;
    scale = std::max(scale, kSpace * (range->second - range->first) / size);
  }
  if (!(scale > kLeastLength)) scale = 1.0 / std::max(width, height);
  const std::array<double, 2> half{0.5 * scale * width, 0.5 * scale * height};
  const double step = round_step(0.8 * std::max(half[0], half[1]));
  return fmt::format(
      "set xrange [{:.7g}:{:.7g}]\nset yrange [{:.7g}:{:.7g}]\nset xtics {:g}\nset ytics {:g}\n",
      middle[0] - half[0],
      middle[0] + half[0],
      middle[1] - half[1],
      middle[1] + half[1],
      step,
      step);
}

/// Equal scales of x and y, and few tics, whose numbers are close to each other in the projection.
/// Ranges end between tics, so that the numbers of two axes do not meet at their common corner.
std::string spatial_axes(const PlotPanel& panel) {
  constexpr double kSpace = 0.54;
  std::array<std::pair<double, double>, 3> range{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range[axis] = bounds(panel, static_cast<Eigen::Index>(axis)).value_or(std::pair{0.0, 0.0});
  }
  const auto length = [&](std::size_t axis) { return range[axis].second - range[axis].first; };
  const double longest = std::max(length(0), length(1));
  if (!(longest > 0.0)) return "set xtics autofreq\nset ytics autofreq\nset ztics autofreq\n";
  std::string out;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double middle = 0.5 * (range[axis].first + range[axis].second);
    out += fmt::format("set {}range [{:.7g}:{:.7g}]\nset {}tics {:g} offset {}\n",
                       axis == 0 ? 'x' : 'y',
                       middle - kSpace * longest,
                       middle + kSpace * longest,
                       axis == 0 ? 'x' : 'y',
                       round_step(0.9 * longest),
                       axis == 0 ? "-0.3,-0.3" : "0.6,-0.2");
  }
  if (!(length(2) > 1e-9 * longest)) return out + "set ztics autofreq\n";
  return out + fmt::format("set ztics {:g}\n", round_step(0.6 * length(2)));
}

}  // namespace

std::string ranges(const PlotPanel& panel) {
  constexpr double kLeastHeight = 1.0;   // [m]
  constexpr double kLeastError = 0.001;  // [m] or [deg]
  const bool is_map = panel.spatial || panel.same_scale;
  const char* const mode = panel.spatial ? " noextend" : "";
  return axis_range("y", panel.series, 1, is_map ? kLeastHeight : kLeastError, mode) +
         axis_range("z", panel.series, 2, kLeastHeight, mode);
}

std::string framed(const PlotPanel& panel, const PanelBox& box, double font) {
  if (panel.spatial) {  // margins of a page would be those of the cube's front, not of its outline
    return fmt::format(
               "unset lmargin\nunset rmargin\nunset bmargin\nunset tmargin\n"
               "set size {:.6f},{:.6f}\nset origin {:.6f},{:.6f}\n"
               "set view 62,35,0.82,1.3\nset xyplane 0\nset xrange [*:*] noextend\n"
               "set zlabel '' rotate by 90 offset 0,0\nset xlabel '' offset 0,0\n",
               box.width / box.page_width,
               box.height / box.page_height,
               box.left / box.page_width,
               box.bottom / box.page_height) +
           ranges(panel) + spatial_axes(panel);
  }
  const double em = font / 72.0;  // [in]
  const double left = 5.6 * em, right = 1.6 * em, bottom = 3.7 * em;
  const double top = (panel.title.empty() ? 0.6 : 2.0) * em;
  const double width = std::max(0.1, box.width - left - right);
  const double height = std::max(0.1, box.height - bottom - top);
  const std::string margins = fmt::format(
      "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
      "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n",
      (box.left + left) / box.page_width,
      (box.left + left + width) / box.page_width,
      (box.bottom + bottom) / box.page_height,
      (box.bottom + bottom + height) / box.page_height);
  const std::string labels = "set xlabel '' offset 0,0.7\n";  // SVG has the tallest lines
  if (panel.same_scale) return margins + labels + equal_scales(panel, width, height);
  return margins + labels + "set xtics autofreq offset 0,0\nset ytics autofreq offset 0,0\n" +
         "set xrange [*:*] noextend\n" + ranges(panel);
}

}  // namespace loopbench::harness
