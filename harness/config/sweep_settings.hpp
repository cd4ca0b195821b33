/// Settings of a config beyond its lists of datasets, methods and metrics. The functions throw
/// InputError `file:line:`; `key` is the name of the setting in messages.
#pragma once

#include <string>
#include <vector>

#include "harness/config/yaml.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

std::vector<metrics::Times> as_times(const YamlNode& node, const std::string& key);

Limits as_limits(const YamlNode& node, const std::string& key);

/// A list of {dataset: PATTERN, method: PATTERN}.
std::vector<Exclusion> as_exclusions(const YamlNode& node, const std::string& key);

TableSpec as_table(const YamlNode& node, const std::string& key);

/// A number of runs; true for timing cells alone; or {runs: N, serial: true}.
void read_timing(const YamlNode& node, Sweep& sweep);

}  // namespace loopbench::harness
