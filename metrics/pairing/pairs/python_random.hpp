/// The draws of Python 3's `random` module, for tools whose numbers hang on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace loopbench {

/// random.seed(0) and then random.randint or random.sample: MT19937 seeded by the array {0}
/// (Matsumoto and Nishimura's init_by_array), whole numbers by refusing too large ones (random.py,
/// _randbelow_with_getrandbits). The same in every Python from 3.2 on; Python 2 drew otherwise.
class PythonRandom {
 public:
  PythonRandom();

  /// 0 .. size - 1, as randint(0, size - 1). 0 < size < 2^32.
  std::size_t below(std::size_t size);

  /// `count` different ones of 0 .. size - 1, as sample(range(size), count). count <= size < 2^32.
  /// O(size) where Python copies the population, else O(count).
  std::vector<std::size_t> sample(std::size_t size, std::size_t count);

 private:
  std::mt19937 bits_;
};

}  // namespace loopbench
