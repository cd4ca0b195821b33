/// Protocols in configs and on command lines.
#pragma once

#include <string>

#include "harness/config/yaml.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

/// `evo`, or `{base: evo, max_diff: 0.02, segments: {step: 5}}`; the default base is loopbench.
/// Throws InputError `file:line:` with a suggestion for an unknown name.
metrics::NamedProtocol protocol_choice(const YamlNode& node, const std::string& file);

/// The protocol of that name with changes. Throws InputError with a suggestion, OptionError.
metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes);

/// A protocol as above, or a list of at most 1000 with different labels.
std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node, const std::string& file);

}  // namespace loopbench::harness
