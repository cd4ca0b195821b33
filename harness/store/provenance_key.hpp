/// Key of provenance rows.
#pragma once

#include <map>
#include <string>

#include "harness/text/hash.hpp"

namespace loopbench::harness {

/// Hash of all key-value pairs of one run's provenance, column `provenance_key`.
inline std::string key_of_provenance(const std::map<std::string, std::string>& provenance) {
  Fields out;
  for (const auto& [key, value] : provenance) out.add(key).add(value);
  return out.hashed();
}

}  // namespace loopbench::harness
