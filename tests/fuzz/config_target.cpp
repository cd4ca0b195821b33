#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace loopbench {

using namespace harness;

void fuzz_config(const std::filesystem::path& file) {
  static const Catalogue known = catalogue({});
  unless_rejected([&] { parse_sweep(fuzz_bytes(file), "fuzz.yaml", known); });
}

}  // namespace loopbench
