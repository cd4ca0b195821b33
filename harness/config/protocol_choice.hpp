/// Protocols in configs and on command lines.
#pragma once

#include <string>
#include <vector>

#include "harness/config/yaml.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

/// The protocol of that name with changes. Throws InputError with a suggestion, OptionError.
metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes);

/// `evo`, or `{base: evo, max_diff: 0.02, segments: {step: 5}}` (the default base is loopbench), or
/// a list of at most 1000 of them with different labels. Throws InputError `file:line:` with a
/// suggestion for an unknown name.
std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node);

}  // namespace loopbench::harness
