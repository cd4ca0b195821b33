/// Comparisons as text.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/export/sheet.hpp"

namespace loopbench {

/// A line per method, best first: median, ratio to the baseline with its interval, wins, losses and
/// ties against it, p, effect size, the ranks that the claims leave, and letters. The best is
/// marked where it is proven. Notes: verdict, remarks.
Sheet sheet(const Comparison& comparison);

/// A line per method of every comparison, numbers in full precision; empty where there is none.
std::string csv(const std::vector<Comparison>& comparisons);

/// An array with an object per comparison: what it is of, verdict, remarks, methods, gaps. On one
/// line with an indent below zero.
std::string json(const std::vector<Comparison>& comparisons, int indent = 2);

}  // namespace loopbench
