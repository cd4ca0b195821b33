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

/// Lines and marks beside the names. They are curves: SVG has no dashed arrows.
struct LegendSamples {
  std::string blocks;
  std::string plots;

  void add(double x1, double x2, double y, const std::string& style) {
    const std::string name = fmt::format("$legend{}", count++);
    blocks += fmt::format("{} << EOD\n{:.5f} {:.5f}\n{:.5f} {:.5f}\nEOD\n", name, x1, y, x2, y);
    plots += (plots.empty() ? "plot " : ", ") + name + " using 1:2 with " + style + " notitle";
  }

  /// Between x1 and x2 [share of the page].
  void add(const PlotSeries& series, double x1, double x2, double y) {
    const std::string color = gnuplot_quoted(series.color);
    const double middle = 0.5 * (x1 + x2);
    const auto mark = [&](const std::string& style) { add(middle, middle, y, "points " + style); };
    if (series.mark == PlotMark::start) return mark("pt 6 ps 0.9 lw 1.5 lc rgb " + color);
    if (series.mark == PlotMark::end) return mark("pt 5 ps 0.8 lc rgb " + color);
    if (series.as_points || series.mark == PlotMark::points) return mark("pt 7 lc rgb " + color);
    if (!series.values.empty()) {  // coloured by value: some colours of the bar
      const double step = (x2 - x1) / 3.0;
      for (int i = 0; i < 3; ++i) {
        add(x1 + i * step,
            x1 + (i + 1) * step,
            y,
            fmt::format("lines lw 2 lc palette frac {}", 0.5 * i));
      }
      return;
    }
    const double width = series.mark == PlotMark::bars ? 5.0 : series.width;
    add(x1, x2, y, fmt::format("lines lw {:g} dt {} lc rgb {}", width, series.dash, color));
  }

  /// On axes that cover the page and are not drawn.
  std::string script() const {
    if (plots.empty()) return "";
    return blocks +
           "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\n"
           "set tmargin at screen 1\nset xrange [0:1]\nset yrange [0:1]\nunset colorbox\n"
           "unset border\nunset tics\n" +
           plots + "\nunset label\nset tics scale 0.6\nset border 31 lc rgb '#666666'\n";
  }

  int count = 0;
};

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
  LegendSamples samples;
  const double column = 1.0 / static_cast<double>(columns_);
  const auto left_of = [&](std::size_t i) {
    return letter + column * static_cast<double>(i % columns_);
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double y = height_of(i / columns_);
    const double end = left_of(i) + (kSampleLetters - 1.0) * letter;
    samples.add(entries_[i], left_of(i), end, y);
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
  return out + samples.script();
}

}  // namespace loopbench::harness
