/// Trajectories cut where no smooth curve is meant, and curves put together again with chords.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "datasets/core/curve.hpp"
#include "methods/report.hpp"

namespace loopbench {

/// Poses first .. last, both included.
struct Stretch {
  std::size_t first, last;

  bool operator==(const Stretch&) const = default;
};

/// Median time between consecutive poses [s]; two poses or more. O(n).
double median_interval(const Trajectory& poses);

/// The poses without the intervals for which `cut(i)`, i to i + 1, holds. One pose or more. O(n).
std::vector<Stretch> stretches(std::size_t poses, const std::function<bool(std::size_t)>& cut);

/// The parts, in the order of time and without overlap, joined by straight lines and great arcs
/// from the end of each to the start of the next: chords. At least two different times.
std::unique_ptr<const Curve> joined(std::vector<std::unique_ptr<const Curve>> parts);

/// Smooths each stretch on its own and joins the results. Counts of `report` are those of the
/// longest stretch, and `chords`; phases, sections and notes are those of all, and a note names
/// `reason` and where the first chord is. With one stretch, exactly `smooth` of everything.
std::unique_ptr<const Curve> smoothed_apart(
    const Trajectory& poses,
    const std::vector<Stretch>& stretches,
    const std::string& reason,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(Trajectory, Report&)>& smooth);

/// Attitudes that one curve cannot follow: cut at every step above 2 rad, then where the solution
/// still fails at its largest step. `solve` gives a curve through the poses, or null. A great arc
/// joins what was cut, with a note. Positions are not meant. O(n) solves at worst.
std::unique_ptr<const Curve> attitudes_apart(
    const Trajectory& poses,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(const Trajectory&)>& solve);

}  // namespace loopbench
