/// Fingerprints of what results depend on. Not for secrets: nobody forges a trajectory here.
///
/// Source: MurmurHash3_x64_128, A. Appleby, SMHasher (public domain), on little-endian machines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace loopbench {

struct Hash {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  bool operator==(const Hash&) const = default;
};

/// Of the bytes. O(n), some gigabytes a second.
Hash hash_of(std::string_view bytes, std::uint32_t seed = 0);

/// Of a whole file, read again every time: a date and a size can lie. Throws InputError.
Hash hash_of_file(const std::filesystem::path& file);

/// 32 lower-case hexadecimal digits.
std::string hex(const Hash& hash);

/// Collects fields so that no two different lists of fields give the same bytes.
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

}  // namespace loopbench
