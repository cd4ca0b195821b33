/// Protocols as configs and command lines name them.
#pragma once

#include <string>

#include "harness/config/yaml.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench {

/// `evo`, or `{base: evo, max_diff: 0.02, segments: {step: 5}}`; base is loopbench when left out.
/// Throws InputError `file:line:` with a suggestion for a slip.
NamedProtocol protocol_choice(const YamlNode& node, const std::string& file);

/// The protocol of that name, changed. Throws InputError with a suggestion, OptionError.
NamedProtocol known_protocol(const std::string& name, const Params& changes);

/// A protocol as above, or a list of at most 1000 whose labels differ.
std::vector<NamedProtocol> protocol_choices(const YamlNode& node, const std::string& file);

}  // namespace loopbench
