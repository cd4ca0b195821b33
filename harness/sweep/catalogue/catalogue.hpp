/// Names that a sweep can use: built-ins and those of plugins.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "methods/method.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

struct Catalogue {
  std::vector<DatasetEntry> datasets;
  std::vector<methods::MethodEntry> methods;
  std::vector<metrics::MetricEntry> metrics;
  /// Of the entries of plugins, by "method NAME", "dataset NAME" or "metric NAME": hashes of their
  /// file and of the libraries that it loads.
  std::map<std::string, std::string> versions = {};
};

/// Built-ins, then the entries of each plugin. Throws InputError for a plugin that cannot be used
/// or one of whose names is already taken.
Catalogue catalogue(const std::vector<std::filesystem::path>& plugins);

/// Whether the method is a joint one with these options. Throws OptionError. A method of a plugin
/// is made in a process of its own; if that fails, its cells report it.
bool is_joint(const Catalogue& catalogue, const methods::MethodEntry& entry, const Params& options);

/// Whether loading the dataset runs a program or a plugin of the user.
bool has_foreign_code(const Catalogue& catalogue, const Choice& dataset);

/// Version of an entry, empty unless it is from a plugin. `kind`: method, dataset or metric.
std::string plugin_version(const Catalogue& catalogue,
                           const std::string& kind,
                           const std::string& name);

/// The entry of that name. Throws InputError with a suggestion.
const DatasetEntry& find_dataset(const Catalogue& catalogue, const std::string& name);
const methods::MethodEntry& find_method(const Catalogue& catalogue, const std::string& name);
/// Whether the method of that name has access to the reference (MethodEntry::make_oracle).
bool is_oracle(const Catalogue& catalogue, const std::string& name);
/// Whether a stage of the method has.
bool uses_reference(const MethodChoice& method, const Catalogue& catalogue);
const metrics::MetricEntry& find_metric(const Catalogue& catalogue, const std::string& name);

}  // namespace loopbench::harness
