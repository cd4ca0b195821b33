#include "harness/sweep/text/hash.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <vector>

#include "datasets/files/regular_file.hpp"

namespace loopbench::harness {

Hash hash_of(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

std::uint64_t hash_after(std::uint64_t before, std::string_view bytes) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), before);
}

Hash hash_of_file(const std::filesystem::path& file) {
  RegularFile in(file, "file");
  std::vector<char> block(std::size_t{1} << 20);
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  for (std::size_t count = block.size(); count == block.size();) {
    count = in.read(block.data(), block.size());
    XXH3_128bits_update(&state, block.data(), count);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return {hash.low64, hash.high64};
}

std::string hex(const Hash& hash) { return fmt::format("{:016x}{:016x}", hash.high, hash.low); }

}  // namespace loopbench::harness
