/// Identification of cells while stores are merged.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "harness/store/digest.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {

/// A cell of the store being added.
struct MergedCell {
  std::int64_t id = 0;
  std::int64_t position = 0;
  std::string key;
  std::string build;
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  bool failed = false;
};

/// A cell of the output.
struct KnownCell {
  std::int64_t id = 0;
  bool failed = false;
};

struct LowBits {
  std::size_t operator()(const Hash& hash) const { return hash.low; }
};

/// Hash of texts and a number, which tells apart millions of cells in 16 bytes each.
inline Hash hash_of_fields(std::initializer_list<std::string_view> texts, std::int64_t number) {
  Fields fields;
  for (const std::string_view text : texts) fields.add(text);
  return parsed_digest(fields.add(std::to_string(number)).hashed());
}

}  // namespace loopbench::harness
