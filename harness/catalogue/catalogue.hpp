/// Names that a sweep can use: built-ins and plugin methods.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "harness/oracle/oracle.hpp"
#include "methods/method.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

struct Catalogue {
  std::vector<DatasetEntry> datasets;
  std::vector<methods::MethodEntry> methods;
  std::vector<metrics::MetricEntry> metrics;
  std::vector<OracleEntry> oracles = {};  ///< those of `methods` with access to the reference
  std::map<std::string, std::string> versions = {};  ///< of plugin methods: hashes of their file
                                                     ///< and of the libraries that it loads
};

/// Built-ins, then the methods of each plugin. Throws InputError for a plugin that cannot be used
/// or whose method name is already taken.
Catalogue catalogue(const std::vector<std::filesystem::path>& plugins);

/// The entry of that name. Throws InputError with a suggestion.
const DatasetEntry& find_dataset(const Catalogue& catalogue, const std::string& name);
const methods::MethodEntry& find_method(const Catalogue& catalogue, const std::string& name);
/// The oracle of that name, or null.
const OracleEntry* find_oracle(const Catalogue& catalogue, const std::string& name);
const metrics::MetricEntry& find_metric(const Catalogue& catalogue, const std::string& name);

}  // namespace loopbench::harness
