/// Random draws of Python 3's `random` module, for tools whose results depend on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace loopbench::metrics {

/// random.seed(0), then random.randint or random.sample: MT19937 seeded by the array {0}
/// (Matsumoto and Nishimura's init_by_array), integers by rejection sampling (random.py,
/// _randbelow_with_getrandbits). Identical in every Python from 3.2 on; Python 2 differs.
class PythonRandom {
 public:
  PythonRandom();

  /// Uniform integer in 0 .. size - 1, as randint(0, size - 1). 0 < size < 2^32.
  std::size_t below(std::size_t size);

  /// `count` distinct integers of 0 .. size - 1, as sample(range(size), count). count <= size <
  /// 2^32. O(size) where Python copies the population, otherwise O(count).
  std::vector<std::size_t> sample(std::size_t size, std::size_t count);

 private:
  std::mt19937 bits_;
};

}  // namespace loopbench::metrics
