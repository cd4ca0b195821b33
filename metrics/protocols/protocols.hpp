/// Evaluation protocols of published tools, by name and version.
#pragma once

#include <vector>

#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

struct ProtocolEntry {
  std::string name;
  std::string version;  ///< commit of the original tool; a counter for our own protocol
  std::string summary;
  Protocol protocol;
};

/// All built-in protocols, the default first.
std::vector<ProtocolEntry> protocols();

/// A protocol with its name, version and changes.
struct NamedProtocol {
  std::string name = "loopbench";
  std::string version = "4";
  Params changes;  ///< fields that differ from the named protocol
  Protocol rules;

  /// For example "evo (align=se3)".
  std::string label() const;
};

/// The entry called `name` with the given fields replaced. Throws InputError with suggestions for
/// an unknown name, OptionError for an unknown, invalid or inconsistent field.
NamedProtocol named_protocol(const std::string& name, const Params& changes = {});

}  // namespace loopbench::metrics
