#include <limits>
#include <new>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

void return_nan(const Scene& scene) {
  scene.estimate.back().world_from_body.translation.x() = std::numeric_limits<double>::quiet_NaN();
}
void return_nothing(const Scene& scene) { scene.estimate.clear(); }
void return_nan_section(const Scene& scene) {
  scene.report.sections.push_back({"s", std::numeric_limits<double>::quiet_NaN(), 1.0, ""});
}
void throw_number(const Scene&) { throw 42; }
void throw_long_text(const Scene&) { throw std::runtime_error(std::string(20 << 20, 'x')); }
void throw_bad_alloc(const Scene&) { throw std::bad_alloc(); }

}  // namespace

std::vector<methods::MethodEntry> lying() {
  return {beast<return_nan>("return_nan"),
          beast<return_nothing>("return_nothing"),
          beast<return_nan_section>("return_nan_section"),
          beast<throw_number>("throw_number"),
          beast<throw_long_text>("throw_long_text"),
          beast<throw_bad_alloc>("throw_bad_alloc")};
}

}  // namespace loopbench::zoo
