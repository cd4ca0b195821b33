/// Hashes of inputs and results; not cryptographic.
///
/// Source: MurmurHash3_x64_128, A. Appleby, SMHasher (public domain), on little-endian machines.
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

/// Hash of the bytes. O(n), some gigabytes per second.
Hash hash_of(std::string_view bytes, std::uint32_t seed = 0);

/// Hash of a regular file, always read completely, since date and size are not reliable. Throws
/// InputError.
Hash hash_of_file(const std::filesystem::path& file);

/// 32 lower-case hexadecimal digits.
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
