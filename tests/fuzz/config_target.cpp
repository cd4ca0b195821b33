#include <fstream>
#include <iterator>

#include "harness/catalogue/catalogue.hpp"
#include "harness/config/read_sweep.hpp"
#include "tests/fuzz/targets.hpp"

namespace loopbench {

using namespace harness;

void fuzz_config(const std::filesystem::path& file) {
  static const Catalogue known = catalogue({});
  std::ifstream in(file, std::ios::binary);
  try {
    parse_sweep({std::istreambuf_iterator<char>(in), {}}, "fuzz.yaml", known);
  } catch (const InputError&) {
    // rejected with a message, as expected
  }
}

}  // namespace loopbench
