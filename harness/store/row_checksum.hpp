/// Checksum of the values of a row: a row whose checksum does not match has changed since it was
/// written. Not cryptographic: it detects accidental changes.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "datasets/core/hash.hpp"

namespace loopbench::harness {

/// The same values in the same order have the same checksum. SQL has it as row_checksum(...).
class RowChecksum {
 public:
  void add(std::int64_t value) { add('i', static_cast<std::uint64_t>(value)); }
  // SQLite stores -0.0 as 0.0.
  void add(double value) { add('r', std::bit_cast<std::uint64_t>(value + 0.0)); }
  void add(std::string_view bytes) { hash_ = hash_combine(hash_ + 't', bytes); }
  void add_null() { add('n', 0); }

  /// 48 bits, which take 6 bytes of a row.
  std::int64_t value() const { return static_cast<std::int64_t>(hash_ >> 16); }

 private:
  void add(char type, std::uint64_t bits) {
    hash_ = hash_combine(hash_ + static_cast<unsigned char>(type), bits);
  }

  std::uint64_t hash_ = 0;
};

}  // namespace loopbench::harness
