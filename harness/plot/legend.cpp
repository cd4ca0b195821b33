#include "harness/plot/legend.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/plot/quoted.hpp"
#include "harness/text/wrap.hpp"

namespace loopbench::harness {
namespace {

constexpr double kLetterWidth = 0.58;  // mean width of a letter over the font size
constexpr double kSampleLetters = 4.0;
constexpr double kEntrySpace = 1.0;  // letters between entries

double inches(double points) { return points / 72.0; }

/// The line or mark beside a name, between x1 and x2 [share of the page].
std::string legend_sample(const PlotSeries& series, double x1, double x2, double y) {
  const std::string color = gnuplot_quoted(series.color);
  const auto mark = [&](const std::string& style) {
    return fmt::format(
        "set label '' at screen {:.5f},{:.5f} point {}\n", 0.5 * (x1 + x2), y, style);
  };
  const auto stroke = [&](double from, double to, const std::string& style) {
    return fmt::format("set arrow from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} nohead {}\n",
                       from,
                       y,
                       to,
                       y,
                       style);
  };
  if (series.mark == PlotMark::start) return mark("pt 6 ps 0.9 lw 1.5 lc rgb " + color);
  if (series.mark == PlotMark::end) return mark("pt 5 ps 0.8 lc rgb " + color);
  if (series.as_points || series.mark == PlotMark::points) return mark("pt 7 lc rgb " + color);
  if (!series.values.empty()) {  // coloured by value: some colours of the bar
    std::string out;
    const double step = (x2 - x1) / 3.0;
    for (int i = 0; i < 3; ++i) {
      out += stroke(
          x1 + i * step, x1 + (i + 1) * step, fmt::format("lw 2 lc palette frac {}", 0.5 * i));
    }
    return out;
  }
  const double width = series.mark == PlotMark::bars ? 5.0 : series.width;
  return stroke(x1, x2, fmt::format("lw {:g} dt {} lc rgb {}", width, series.dash, color));
}

}  // namespace

Legend::Legend(const std::vector<PlotPanel>& panels,
               const std::string& note,
               double width,
               double font)
    : note_(note), width_(width), font_(font) {
  for (const PlotPanel& panel : panels) {
    for (const PlotSeries& series : panel.series) {
      const bool is_known = std::ranges::any_of(
          entries_, [&](const PlotSeries& known) { return known.name == series.name; });
      if (series.name.empty() || is_known) continue;
      PlotSeries entry = series;
      entry.points.clear();
      if (!entry.values.empty()) entry.values.resize(1);  // only whether there are any
      entries_.push_back(std::move(entry));
    }
  }
  if (entries_.size() > kMostLegendEntries) {
    more_ = entries_.size() - (kMostLegendEntries - 1);
    entries_.resize(kMostLegendEntries - 1);
  }
  const auto most = std::max<std::size_t>(4, letters(width_) - 6);
  std::size_t longest = 0;
  for (PlotSeries& entry : entries_) {
    entry.name = shortened(entry.name, most);
    longest = std::max(longest, loopbench::harness::width(entry.name));
  }
  if (entries_.empty()) return;
  const double needed = static_cast<double>(longest) + kSampleLetters + kEntrySpace;
  const auto fitting = static_cast<std::size_t>(static_cast<double>(letters(width_)) / needed);
  columns_ = std::clamp<std::size_t>(fitting, 1, entries_.size() + (more_ > 0 ? 1 : 0));
}

double Legend::line() const { return 1.45 * inches(font_); }

std::size_t Legend::letters(double width) const {
  return static_cast<std::size_t>(width / (kLetterWidth * inches(font_)));
}

double Legend::height() const {
  const std::size_t entries = entries_.size() + (more_ > 0 ? 1 : 0);
  const std::size_t rows = (entries + columns_ - 1) / columns_ + (note_.empty() ? 0 : 1);
  return rows == 0 ? 0.0 : line() * (static_cast<double>(rows) + 0.5);
}

std::string Legend::script(double page_height) const {
  std::string out;
  const double letter = kLetterWidth * inches(font_) / width_;  // [share of the page]
  const auto height_of = [&](std::size_t row) {
    return 1.0 - line() * (static_cast<double>(row) + 0.75) / page_height;
  };
  const auto text = [&](const std::string& words, double x, double y) {
    out += fmt::format("set label {} at screen {:.5f},{:.5f} left\n", gnuplot_quoted(words), x, y);
  };
  const double column = 1.0 / static_cast<double>(columns_);
  const auto left_of = [&](std::size_t i) {
    return letter + column * static_cast<double>(i % columns_);
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double y = height_of(i / columns_);
    const double end = left_of(i) + (kSampleLetters - 1.0) * letter;
    out += legend_sample(entries_[i], left_of(i), end, y);
    text(entries_[i].name, left_of(i) + kSampleLetters * letter, y);
  }
  std::size_t entries = entries_.size();
  if (more_ > 0) {
    text(fmt::format("and {} more", more_), left_of(entries), height_of(entries / columns_));
    ++entries;
  }
  if (!note_.empty()) {
    text(cut(note_, letters(width_) - 2), letter, height_of((entries + columns_ - 1) / columns_));
  }
  return out;
}

}  // namespace loopbench::harness
