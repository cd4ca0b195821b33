/// Hashes of inputs and results by xxHash (XXH3); not cryptographic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace loopbench::harness {

struct Hash {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  bool operator==(const Hash&) const = default;
};

/// XXH3 of 128 bits. O(n), some gigabytes per second.
Hash hash_of(std::string_view bytes);

/// XXH3 of 64 bits that continues a hash: that of all bytes `before` is the seed.
std::uint64_t hash_after(std::uint64_t before, std::string_view bytes);

/// XXH3 of 128 bits of a regular file, always read completely, since date and size are not
/// reliable. Throws InputError.
Hash hash_of_file(const std::filesystem::path& file);

/// 32 lower-case hexadecimal digits, as `xxhsum -H2 FILE` prints them.
std::string hex(const Hash& hash);

/// Serialises fields unambiguously: different lists of fields give different bytes.
class Fields {
 public:
  Fields& add(std::string_view field) {
    bytes_ += std::to_string(field.size());
    bytes_ += ':';
    bytes_ += field;
    return *this;
  }
  std::string hashed() const { return hex(hash_of(bytes_)); }

 private:
  std::string bytes_;
};

}  // namespace loopbench::harness
