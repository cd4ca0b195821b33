/// The datasets, methods, metrics and protocols of a config or a command line, with names and
/// options checked. The functions throw InputError `file:line:` for an unknown name or option, or
/// an invalid value.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/entry.hpp"
#include "harness/sweep/config/paths.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

/// Also reads the `group` of the data. Patterns in paths are searched in `folders`.
std::vector<DatasetChoice> read_datasets(const YamlNode& entry,
                                         const Catalogue& catalogue,
                                         const Folders& folders);

std::vector<MethodChoice> method_choices(const ConfigEntry& entry, const Catalogue& catalogue);

/// The options of a metric must be compatible with each of the protocols.
std::vector<MetricChoice> metric_choices(const ConfigEntry& entry,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols);

/// The protocol of that name with changes. Throws InputError with a suggestion, OptionError.
metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes);

/// `evo`, or `{base: evo, max_diff: 0.02, segments: {step: 5}}` (the default base is loopbench), or
/// a list of them with different labels. Throws InputError `file:line:` with a
/// suggestion for an unknown name.
std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node);

}  // namespace loopbench::harness
