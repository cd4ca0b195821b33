/// Expands a config entry with `sweep:` and `zip:` into all its settings.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/config/yaml.hpp"

namespace loopbench::harness {

/// An option's value, and where it was given.
struct Setting {
  std::string name;  ///< nested maps flattened: segment: {band: 1} is segment.band
  Param value;
  Place place;
  std::string text = {};  ///< the value as written; empty if computed
};

/// One point of the grid: fixed settings, then swept ones (also listed in `swept`, in order).
struct GridPoint {
  std::vector<Setting> settings;
  std::vector<std::string> swept;
  std::vector<std::string> matched = {};  ///< texts of the wildcards in paths, see paths.hpp
};

/// Throws InputError `file:line:` if two settings of the point have the same name.
void reject_repeats(const GridPoint& point);

/// Every combination of `entry`'s scalar keys (except those in `reserved`), its `sweep` (each key a
/// list or {from, to, steps, log}) and its `zip` (lists of equal length, advanced together). The
/// first swept key varies slowest. `from: 1, to: 3, steps: 3` is 1 2 3; with `log: true` evenly
/// spaced in the logarithm; values are integers if every step is an integer. Throws InputError
/// `file:line:`.
std::vector<GridPoint> expand(const YamlNode& entry, const std::vector<std::string>& reserved);

}  // namespace loopbench::harness
