/// Numbers for texts that are derived from records.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "datasets/core/hash.hpp"
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

inline TextIndex::TextIndex(const std::vector<std::string>& fields, Derive derive)
    : derive_(std::move(derive)) {
  for (const std::string& name : fields) {
    std::vector<Part> own = parts_of(name);
    if (own.empty()) field(Record{}, name);  // throws
    std::move(own.begin(), own.end(), std::back_inserter(parts_));
  }
}

/// The values on which a field depends; none for another field.
inline std::vector<TextIndex::Part> TextIndex::parts_of(const std::string& field) {
  if (field == "repeat")
    return {[](const Record& r) { return static_cast<std::uintptr_t>(r.repeat); }};
  if (field == "status")
    return {[](const Record& r) { return static_cast<std::uintptr_t>(r.status); }};
  if (field == "oracle") return {[](const Record& r) { return std::uintptr_t{r.oracle}; }};
  const std::pair<const char*, std::vector<SharedText Record::*>> texts[] = {
      {"sequence", {&Record::sequence}},
      {"method", {&Record::method}},
      {"closures", {&Record::closures}},
      {"protocol", {&Record::protocol}},
      {"protocol_version", {&Record::protocol_version}},
      {"times", {&Record::times}},
      {"metric", {&Record::metric}},
      {"label", {&Record::metric, &Record::label}},
      {"relation", {&Record::relation}},
      {"axis", {&Record::axis}},
      {"unit", {&Record::unit}},
      {"score", {&Record::metric, &Record::label, &Record::relation, &Record::axis}},
      {"content", {&Record::content}},
      {"group", {&Record::group}}};
  std::vector<Part> out;
  for (const auto& [name, members] : texts) {
    if (field != name) continue;
    for (const auto member : members) {
      out.emplace_back(
          [member](const Record& r) { return std::bit_cast<std::uintptr_t>((r.*member).id()); });
    }
  }
  return out;
}

inline std::size_t TextIndex::KeyHash::operator()(const Key& key) const {
  std::uint64_t out = 0;
  for (const std::uintptr_t part : key) out = hash_combine(out, part);
  return static_cast<std::size_t>(out);
}

inline std::size_t TextIndex::index(const Record& record) {
  key_.clear();
  for (const Part& part : parts_) key_.push_back(part(record));
  const auto known = by_key_.find(key_);
  if (known != by_key_.end()) return known->second;
  const auto [text, is_new] = by_text_.emplace(derive_(record), texts_.size());
  if (is_new) texts_.push_back(text->first);
  by_key_.emplace(key_, text->second);
  return text->second;
}

}  // namespace loopbench::harness
