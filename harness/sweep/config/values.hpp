/// Values of YAML nodes with their types checked. Each function throws InputError
/// `file:line: key: what is accepted`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "harness/sweep/config/yaml.hpp"

namespace loopbench::harness {

std::string as_text(const YamlNode& node, const std::string& key);

/// A list of texts, or one text.
std::vector<std::string> as_texts(const YamlNode& node, const std::string& key);

/// A whole number from 1 to `most`.
std::int64_t as_integer(const YamlNode& node, const std::string& key, std::int64_t most);

/// A whole number from 1 to a million.
int as_count(const YamlNode& node, const std::string& key);

/// A finite number, by default any.
double as_number(const YamlNode& node,
                 const std::string& key,
                 const Between& range = {-std::numeric_limits<double>::max(),
                                         std::numeric_limits<double>::max()});

bool as_flag(const YamlNode& node, const std::string& key);

/// A regular expression.
std::string as_pattern(const YamlNode& node, const std::string& key);

/// A memory size [bytes]: "2GiB", "1.5 GiB", "500MB" or "4096", at least one; 0 for "none". KiB,
/// MiB, GiB are powers of 1024; kB, MB, GB of 1000.
std::int64_t as_bytes(const YamlNode& node, const std::string& key);

/// Throws unless the node is a map.
void require_map(const YamlNode& node, const std::string& key, const std::string& expected);

/// An error for each key of a map that is not `known`, with a suggestion.
std::vector<InputError> unknown_keys(const YamlNode& node, const std::vector<std::string>& known);

/// Settings for which only a map with the `known` keys is accepted.
void require_keys(const YamlNode& node,
                  const std::string& key,
                  const std::vector<std::string>& known);

/// Sets `out` to the value of a map's key, if it has one: `as` is one of the functions above. `key`
/// can be preceded by those of its parents, for messages: limits.memory.
template <class Value, class As>
void read_key(const YamlNode& map, const std::string& key, Value& out, As as) {
  const YamlNode* node = map.find(key.substr(key.rfind('.') + 1));
  if (node != nullptr) out = as(*node, key);
}

}  // namespace loopbench::harness
