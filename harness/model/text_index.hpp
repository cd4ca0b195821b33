/// Numbers for texts that are derived from records.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Numbers the texts of records in order of appearance. A text is derived only once from records
/// whose fields are equal, and records that follow each other in the same order again are found
/// without a search, so that index() mostly costs a few comparisons of pointers.
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
  static constexpr std::size_t kParts = 16;
  static constexpr std::size_t kStatus = kParts - 3, kRepeat = kParts - 2, kOracle = kParts - 1;
  using Key = std::array<std::uintptr_t, kParts>;  ///< of the members, zeros, and these three
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  /// One combination of fields.
  struct Combination {
    Key key{};
    std::size_t index = 0;  ///< of its text
    std::size_t next = 0;   ///< the combination that followed it last
  };

  void add_member(SharedText Record::*member);
  Key key_of(const Record& record) const;
  bool is_like(const Record& record, const Key& key) const;
  // 0 if the text does not depend on it.
  std::uintptr_t repeat_of(const Record& record) const {
    return has_repeat_ ? static_cast<std::uintptr_t>(record.repeat) : 0;
  }
  std::uintptr_t oracle_of(const Record& record) const {
    return has_oracle_ && record.oracle ? 1 : 0;
  }
  std::uintptr_t status_of(const Record& record) const {
    return has_status_ ? static_cast<std::uintptr_t>(record.status) : 0;
  }
  std::size_t combination_of(const Record& record);

  Derive derive_;
  std::vector<SharedText Record::*> members_;
  bool has_repeat_ = false;
  bool has_oracle_ = false;
  bool has_status_ = false;
  std::vector<Combination> combinations_;
  std::size_t last_ = 0;  ///< combination of the last record
  std::unordered_map<Key, std::size_t, KeyHash> by_key_;
  std::unordered_map<std::string, std::size_t> by_text_;
  std::vector<std::string> texts_;
};

}  // namespace loopbench::harness
