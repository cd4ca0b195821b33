/// Hash of rows, by which readers notice rows that have changed since they were written, are
/// missing or were added. Not cryptographic: it detects accidental changes.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "harness/base/hash.hpp"

namespace loopbench::harness {

/// The values of one row. The same values in the same order have the same hash.
class RowHash {
 public:
  template <std::integral Integer>
  void add(Integer value) {
    add_bytes('i', static_cast<std::int64_t>(value));
  }
  void add(double value) {
    std::isnan(value) ? add_null() : add_bytes('r', value + 0.0);  // SQLite stores -0.0 as 0.0
  }
  void add(std::string_view bytes) {
    add_bytes('t', bytes.size());
    bytes_ += bytes;
  }
  void add_null() { bytes_ += 'n'; }
  void clear() { bytes_.clear(); }

  /// `before`: hash of the rows before this one; 0: it is the first.
  std::uint64_t after(std::uint64_t before) const { return hash_after(before, bytes_); }

 private:
  template <class Value>
  void add_bytes(char type, Value value) {
    bytes_ += type;
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::string bytes_;
};

/// Id of the definition of a score from the hash of its row: 48 bits, which take 6 bytes of a
/// score.
inline std::int64_t definition_id(std::uint64_t hash) {
  return static_cast<std::int64_t>(hash >> 16);
}

}  // namespace loopbench::harness
