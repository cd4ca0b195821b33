#include "harness/text/hash.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cstring>

#include "datasets/core/error.hpp"

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

}  // namespace

Hash hash_of(std::string_view bytes, std::uint32_t seed) {
  std::uint64_t low = seed;
  std::uint64_t high = seed;
  std::size_t at = 0;
  for (; at + 16 <= bytes.size(); at += 16) {
    std::uint64_t block[2];
    std::memcpy(block, bytes.data() + at, sizeof block);
    low = (std::rotl(low ^ first_mixed(block[0]), 27) + high) * 5 + 0x52dce729;
    high = (std::rotl(high ^ second_mixed(block[1]), 31) + low) * 5 + 0x38495ab5;
  }
  std::uint64_t rest[2] = {0, 0};
  if (at < bytes.size()) std::memcpy(rest, bytes.data() + at, bytes.size() - at);
  high ^= second_mixed(rest[1]);  // no effect without remaining bytes
  low ^= first_mixed(rest[0]);
  low ^= bytes.size();
  high ^= bytes.size();
  low += high;
  high += low;
  low = finished(low);
  high = finished(high);
  low += high;
  high += low;
  return {low, high};
}

Hash hash_of_file(const std::filesystem::path& file) {
  const auto refuse = [&] {
    return InputError(file.string() + ": cannot be read: " + std::strerror(errno));
  };
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw refuse();
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || S_ISDIR(status.st_mode)) {
    if (S_ISDIR(status.st_mode)) errno = EISDIR;
    const InputError error = refuse();
    close(descriptor);
    throw error;
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) {
    close(descriptor);
    return hash_of("");
  }
  void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (bytes == MAP_FAILED) throw refuse();
  const Hash out = hash_of({static_cast<const char*>(bytes), size});
  munmap(bytes, size);
  return out;
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
