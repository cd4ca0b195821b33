/// The lists of a config (datasets, methods, metrics), each entry expanded into choices.
#pragma once

#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/config/paths.hpp"
#include "harness/config/yaml.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Patterns in paths are searched in `folders`. Each throws InputError `file:line:` for an unknown
/// name or option, or an invalid value.
std::vector<DatasetChoice> dataset_choices(const YamlNode& entry,
                                           const std::string& file,
                                           const Catalogue& catalogue,
                                           const Folders& folders);
std::vector<MethodChoice> method_choices(const YamlNode& entry,
                                         const std::string& file,
                                         const Catalogue& catalogue);
/// The options of a metric must be compatible with each of the protocols.
std::vector<MetricChoice> metric_choices(const YamlNode& entry,
                                         const std::string& file,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols);

}  // namespace loopbench::harness
