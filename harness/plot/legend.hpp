/// One legend for all panels of a figure.
#pragma once

#include <string>
#include <vector>

#include "harness/plot/gnuplot.hpp"

namespace loopbench::harness {

inline constexpr std::size_t kMostLegendEntries = 12;

/// Rows of entries above the panels. Entries are labels and curves on the page: gnuplot's own
/// legend covers panels or leaves out entries if they do not fit.
class Legend {
 public:
  /// One entry per name of a series, in order of appearance; after kMostLegendEntries "and N more".
  /// `note` is a line of text below them, or empty. `width` [in], `font` [pt].
  Legend(const std::vector<PlotPanel>& panels, const std::string& note, double width, double font);

  double height() const;  ///< [in]

  /// Commands to be placed before the first panel of a page of `page_height` [in].
  std::string script(double page_height) const;

 private:
  double line() const;                ///< height of a row [in]
  std::size_t letters(double) const;  ///< that fit into a width [in]
  std::vector<PlotSeries> entries_;   ///< without points
  std::size_t more_ = 0;              ///< entries that are left out
  std::size_t columns_ = 1;
  std::string note_;
  double width_;
  double font_;
};

}  // namespace loopbench::harness
