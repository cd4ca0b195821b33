/// YAML tree with line numbers; the only place that uses yaml-cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"

namespace loopbench::harness {

/// A line of a file, or with line 0 an option of the command line.
struct Place {
  std::shared_ptr<const std::string> file;
  std::size_t line = 0;  ///< counted from 1; 0: unknown

  explicit Place(const std::string& name, std::size_t at = 0)
      : file(std::make_shared<const std::string>(name)), line(at) {}

  /// `file:line: what`.
  InputError error(const std::string& what) const { return input_error(*file, line, what); }
};

struct YamlEntry;

/// A scalar, a list or a map, with the line it starts on. Maps keep their order.
struct YamlNode : Place {
  enum class Type { null, scalar, list, map };

  explicit YamlNode(Place place, Type kind = Type::null);

  Type type;
  Param scalar;
  std::string text;          ///< of a scalar, as written
  bool is_anchored = false;  ///< value of a key at top level that has an anchor
  std::vector<YamlNode> list;
  std::vector<YamlEntry> map;

  /// The value of a map's key, or null.
  const YamlNode* find(const std::string& key) const;
};

struct YamlEntry {
  std::string key;
  YamlNode value;
};

inline YamlNode::YamlNode(Place place, Type kind) : Place(std::move(place)), type(kind) {}

inline const YamlNode* YamlNode::find(const std::string& key) const {
  for (const YamlEntry& entry : map) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

/// Plain scalars become bool, integer, real number or text, in this order; quoted scalars remain
/// text. Merge keys (`<<: *base`) are replaced by the entries of the maps. Throws InputError
/// `file:line:` for invalid YAML, a repeated key, a key that is not a string, more than one
/// document, or more than 1 MB of text, 100000 values or 10 MB of text after expanding aliases.
YamlNode parse_yaml(const std::string& text, const std::string& file);

}  // namespace loopbench::harness
