#include "metrics/pairing/python_random.hpp"

#include <bit>
#include <numeric>
#include <unordered_set>

namespace loopbench::metrics {
namespace {

/// State after init_by_array({0}); mt19937 takes the 32-bit words unchanged.
struct SeedZero {
  using result_type = std::uint32_t;

  template <class Iterator>
  void generate(Iterator begin, Iterator end) {
    const auto size = static_cast<std::uint32_t>(end - begin);
    const auto mixed = [&](std::uint32_t i) {
      const std::uint32_t before = begin[i - 1];
      return before ^ (before >> 30U);
    };
    begin[0] = 19650218U;
    for (std::uint32_t i = 1; i < size; ++i) begin[i] = 1812433253U * mixed(i) + i;
    std::uint32_t i = 1;
    const auto next = [&] {
      if (++i < size) return;
      begin[0] = begin[size - 1];
      i = 1;
    };
    for (std::uint32_t k = 0; k < size; ++k, next()) begin[i] = begin[i] ^ (mixed(i) * 1664525U);
    for (std::uint32_t k = 1; k < size; ++k, next()) {
      begin[i] = (begin[i] ^ (mixed(i) * 1566083941U)) - i;
    }
    begin[0] = 0x80000000U;
  }
};

std::mt19937 seeded() {
  SeedZero zero;
  return std::mt19937(zero);
}

}  // namespace

PythonRandom::PythonRandom() : bits_(seeded()) {}

std::size_t PythonRandom::below(std::size_t size) {
  const auto width = static_cast<unsigned>(std::bit_width(size));
  std::size_t out = size;
  while (out >= size) out = static_cast<std::size_t>(bits_()) >> (32U - width);
  return out;
}

std::vector<std::size_t> PythonRandom::sample(std::size_t size, std::size_t count) {
  // Python's size estimate for a set of `count`; it copies a smaller population instead.
  std::size_t set_size = 21;
  if (count > 5) {
    std::size_t table = 1;
    while (table < 3 * count) table *= 4;
    set_size += table;
  }
  std::vector<std::size_t> out(count);
  if (size <= set_size) {
    std::vector<std::size_t> left(size);
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = below(size - k);
      out[k] = left[at];
      left[at] = left[size - k - 1];
    }
  } else {
    std::unordered_set<std::size_t> seen;
    for (std::size_t& drawn : out) {
      do {
        drawn = below(size);
      } while (!seen.insert(drawn).second);
    }
  }
  return out;
}

}  // namespace loopbench::metrics
