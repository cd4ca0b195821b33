/// Keys of the maps of a config: what is accepted, and what `list --json` describes.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

struct ConfigKey {
  std::string name;
  std::string help;  ///< meaning, with the unit in brackets
};

/// Keys of the config ("") or of its maps `limits`, `timing`, `table` and `exclude`. Throws
/// std::out_of_range for another name.
inline const std::vector<ConfigKey>& config_keys(const std::string& map) {
  static const std::map<std::string, std::vector<ConfigKey>> all{
      {"",
       {{"description", "text about the sweep"},
        {"plugins", "shared objects with methods, metrics or datasets, relative to this file"},
        {"datasets", "sequences: names, or maps with dataset, label, group, protocol and options"},
        {"methods", "methods: names, corrector + smoother, or maps with method, label and options"},
        {"metrics", "metrics: names, or maps with metric, label and options"},
        {"times", "evaluation times: keyframes, dense or both"},
        {"protocol", "rules of association, alignment and statistics: a name, a map or a list"},
        {"baseline", "label of the method that gain refers to"},
        {"min_coverage", "smallest coverage of a complete result [1]"},
        {"repeats", "instances of every dataset with a seed"},
        {"timing",
         "timed runs of each method; true: until their CPU time is known to 2 %, one cell at a "
         "time"},
        {"traces", "whether trajectories are stored for reports"},
        {"limits", "limits of one cell and of the sweep"},
        {"exclude", "cells to leave out"},
        {"table", "layout of the printed table"}}},
      {"limits",
       {{"seconds", "wall time of one cell [s]; 0: no limit"},
        {"memory", "resident size of one cell: 2GiB, 500MB or bytes; none: no limit"},
        {"processes", "largest number of processes of one cell, apart from threads"},
        {"cells", "largest number of cells of the sweep"}}},
      {"timing",
       {{"runs", "timed runs of each method; with a precision the most, default 100"},
        {"precision",
         "relative standard error of the mean CPU time at which the runs end, after at least 5 "
         "[1]; "
         "0: none"},
        {"serial", "whether cells run one at a time, on one core"}}},
      {"table",
       {{"rows", "columns of the long table that name a row"},
        {"columns", "columns of the long table that name a column"},
        {"split", "columns of the long table with one table for each value"},
        {"value", fmt::format("statistic: {}", fmt::join(statistic_names(), ", "))},
        {"show", "scores to show, by their short names"},
        {"where", "filters of rows: column=value or column!=value"},
        {"plus_minus", "whether means have their standard deviations"}}},
      {"exclude",
       {{"dataset", "regular expression for the label of the dataset"},
        {"method", "regular expression for the label of the method"}}}};
  return all.at(map);
}

/// Their names.
inline std::vector<std::string> config_key_names(const std::string& map) {
  std::vector<std::string> out;
  for (const ConfigKey& key : config_keys(map)) out.push_back(key.name);
  return out;
}

}  // namespace loopbench::harness
