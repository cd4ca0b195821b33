/// The tools whose numbers papers quote, each as a protocol with a name and a version.
#pragma once

#include <vector>

#include "metrics/protocols/protocol.hpp"

namespace loopbench {

struct ProtocolEntry {
  std::string name;
  std::string version;  ///< commit of the original that was read or run; our own count for ours
  std::string summary;
  Protocol protocol;
};

/// Every built-in, the default first.
std::vector<ProtocolEntry> protocols();

/// A protocol as it is used: where it comes from and what was changed.
struct NamedProtocol {
  std::string name = "loopbench";
  std::string version = "3";
  Params changes;  ///< those that differ from the named one
  Protocol rules;

  /// "evo (align=se3)".
  std::string label() const;
};

/// The entry called `name` with the given fields replaced. Throws InputError with a suggestion of
/// names for an unknown one, OptionError for an unknown, wrong or incoherent field.
NamedProtocol named_protocol(const std::string& name, const Params& changes = {});

}  // namespace loopbench
