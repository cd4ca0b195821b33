/// SHA-256 of downloads and of the parts of a page.
///
/// Source: FIPS 180-4.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace loopbench::harness {

class Sha256 {
 public:
  void add(std::string_view bytes);
  /// The 32 bytes of the hash. Call it once, after the last `add`.
  std::string digest();
  /// digest() as 64 lower-case hexadecimal digits.
  std::string hex();

 private:
  void block(const unsigned char* bytes);

  std::array<std::uint32_t, 8> state_{0x6a09e667,
                                      0xbb67ae85,
                                      0x3c6ef372,
                                      0xa54ff53a,
                                      0x510e527f,
                                      0x9b05688c,
                                      0x1f83d9ab,
                                      0x5be0cd19};
  std::array<unsigned char, 64> pending_{};
  std::size_t pending_size_ = 0;
  std::uint64_t total_ = 0;  // bytes
};

/// SHA-256 of a file's content. Throws InputError.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace loopbench::harness
