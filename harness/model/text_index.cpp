#include "harness/model/text_index.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "datasets/hash.hpp"

namespace loopbench::harness {
namespace {

std::uintptr_t id_of(const SharedText& text) { return std::bit_cast<std::uintptr_t>(text.id()); }

/// The texts on which a field depends; none for another field.
std::vector<SharedText Record::*> members_of(const std::string& field) {
  const std::pair<const char*, std::vector<SharedText Record::*>> all[] = {
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
  for (const auto& [name, members] : all) {
    if (field == name) return members;
  }
  return {};
}

}  // namespace

TextIndex::TextIndex(const std::vector<std::string>& fields, Derive derive)
    : derive_(std::move(derive)) {
  for (const std::string& name : fields) {
    const std::vector<SharedText Record::*> members = members_of(name);
    if (name == "repeat") {
      has_repeat_ = true;
    } else if (name == "oracle") {
      has_oracle_ = true;
    } else if (name == "status") {
      has_status_ = true;
    } else if (members.empty()) {
      field(Record{}, name);  // throws
    }
    for (const auto member : members) add_member(member);
  }
}

void TextIndex::add_member(SharedText Record::*member) {
  if (std::ranges::count(members_, member) == 0) members_.push_back(member);
}

std::size_t TextIndex::KeyHash::operator()(const Key& key) const {
  std::uint64_t out = 0;
  for (const std::uintptr_t part : key) out = mixed(out, part);
  return static_cast<std::size_t>(out);
}

TextIndex::Key TextIndex::key_of(const Record& record) const {
  Key out{};
  for (std::size_t i = 0; i < members_.size(); ++i) out[i] = id_of(record.*members_[i]);
  out[kRepeat] = repeat_of(record);
  out[kOracle] = oracle_of(record);
  out[kStatus] = status_of(record);
  return out;
}

bool TextIndex::is_like(const Record& record, const Key& key) const {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (key[i] != id_of(record.*members_[i])) return false;
  }
  return key[kRepeat] == repeat_of(record) && key[kOracle] == oracle_of(record) &&
         key[kStatus] == status_of(record);
}

std::size_t TextIndex::combination_of(const Record& record) {
  const Key key = key_of(record);
  const auto [found, is_new] = by_key_.emplace(key, combinations_.size());
  if (is_new) {
    const auto [place, is_new_text] = by_text_.emplace(derive_(record), texts_.size());
    if (is_new_text) texts_.push_back(place->first);
    combinations_.push_back({key, place->second, 0});
  }
  return found->second;
}

std::size_t TextIndex::index(const Record& record) {
  if (combinations_.empty()) return combinations_[combination_of(record)].index;
  if (is_like(record, combinations_[last_].key)) return combinations_[last_].index;
  std::size_t own = combinations_[last_].next;
  if (!is_like(record, combinations_[own].key)) {
    own = combination_of(record);
    combinations_[last_].next = own;
  }
  last_ = own;
  return combinations_[own].index;
}

}  // namespace loopbench::harness
