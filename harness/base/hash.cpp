#include "harness/base/hash.hpp"

#include <bit>
#include <cstring>
#include <vector>

#include "datasets/formats/regular_file.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kFirst = 0x87c37b91114253d5ULL;
constexpr std::uint64_t kSecond = 0x4cf5ad432745937fULL;

std::uint64_t first_mixed(std::uint64_t k) { return std::rotl(k * kFirst, 31) * kSecond; }
std::uint64_t second_mixed(std::uint64_t k) { return std::rotl(k * kSecond, 33) * kFirst; }

std::uint64_t finished(std::uint64_t k) {
  k ^= k >> 33;
  k *= 0xff51afd7ed558ccdULL;
  k ^= k >> 33;
  k *= 0xc4ceb9fe1a85ec53ULL;
  return k ^ (k >> 33);
}

/// The state between blocks of 16 bytes.
struct Murmur {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  std::uint64_t size = 0;

  /// Returns the bytes that do not fill a block.
  std::string_view add(std::string_view bytes) {
    size += bytes.size();
    for (; bytes.size() >= 16; bytes.remove_prefix(16)) {
      std::uint64_t block[2];
      std::memcpy(block, bytes.data(), sizeof block);
      low = (std::rotl(low ^ first_mixed(block[0]), 27) + high) * 5 + 0x52dce729;
      high = (std::rotl(high ^ second_mixed(block[1]), 31) + low) * 5 + 0x38495ab5;
    }
    return bytes;
  }

  Hash finish(std::string_view tail) {
    std::uint64_t rest[2] = {0, 0};
    if (!tail.empty()) std::memcpy(rest, tail.data(), tail.size());
    high ^= second_mixed(rest[1]);  // no effect without remaining bytes
    low ^= first_mixed(rest[0]);
    low ^= size;
    high ^= size;
    low += high;
    high += low;
    low = finished(low);
    high = finished(high);
    low += high;
    high += low;
    return {low, high};
  }
};

}  // namespace

Hash hash_of(std::string_view bytes, std::uint32_t seed) {
  Murmur murmur{.low = seed, .high = seed};
  return murmur.finish(murmur.add(bytes));
}

Hash hash_of_file(const std::filesystem::path& file) {
  RegularFile in(file, "file");
  std::vector<char> block(std::size_t{1} << 20);  // a multiple of 16; only the last is shorter
  Murmur murmur;
  std::string_view tail;
  for (bool is_last = false; !is_last;) {
    tail = {block.data(), in.read(block.data(), block.size())};
    is_last = tail.size() < block.size();
    tail = murmur.add(tail);
  }
  return murmur.finish(tail);
}

std::string hex(const Hash& hash) {
  std::string out(32, '0');
  for (std::size_t i = 0; i < 16; ++i) {
    const std::size_t shift = 60 - 4 * i;
    out[i] = "0123456789abcdef"[hash.low >> shift & 15];
    out[16 + i] = "0123456789abcdef"[hash.high >> shift & 15];
  }
  return out;
}

}  // namespace loopbench::harness
