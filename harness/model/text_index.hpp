/// Numbers for texts that are derived from records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Numbers the texts of records in order of appearance. A text is derived only once from records
/// whose fields are equal, so that index() mostly costs a comparison of pointers.
class TextIndex {
 public:
  using Derive = std::function<std::string(const Record&)>;

  /// `fields`: those that the text depends on, as in field(), or content, group or oracle. Throws
  /// InputError for an unknown one.
  TextIndex(const std::vector<std::string>& fields, Derive derive);

  std::size_t index(const Record& record);

  /// By number.
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  using Part = std::function<std::uintptr_t(const Record&)>;
  using Key = std::vector<std::uintptr_t>;  ///< the value of each part
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  static std::vector<Part> parts_of(const std::string& field);

  Derive derive_;
  std::vector<Part> parts_;
  Key key_;  ///< of the last record
  std::unordered_map<Key, std::size_t, KeyHash> by_key_;
  std::unordered_map<std::string, std::size_t> by_text_;
  std::vector<std::string> texts_;
};

}  // namespace loopbench::harness
