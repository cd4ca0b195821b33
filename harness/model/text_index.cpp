#include "harness/model/text_index.hpp"

#include <bit>
#include <iterator>
#include <utility>

#include "datasets/core/hash.hpp"

namespace loopbench::harness {

TextIndex::TextIndex(const std::vector<std::string>& fields, Derive derive)
    : derive_(std::move(derive)) {
  for (const std::string& name : fields) {
    std::vector<Part> own = parts_of(name);
    if (own.empty()) field(Record{}, name);  // throws
    std::move(own.begin(), own.end(), std::back_inserter(parts_));
  }
}

/// The values on which a field depends; none for another field.
std::vector<TextIndex::Part> TextIndex::parts_of(const std::string& field) {
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

std::size_t TextIndex::KeyHash::operator()(const Key& key) const {
  std::uint64_t out = 0;
  for (const std::uintptr_t part : key) out = hash_combine(out, part);
  return static_cast<std::size_t>(out);
}

std::size_t TextIndex::index(const Record& record) {
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
