/// Methods that return or throw what they should not.
#include <limits>
#include <new>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

BEAST(return_nan) {
  scene.estimate.back().world_from_body.translation.x() = std::numeric_limits<double>::quiet_NaN();
}
BEAST(return_nothing) { scene.estimate.clear(); }
BEAST(return_nan_section) {
  scene.report.sections.push_back({"s", std::numeric_limits<double>::quiet_NaN(), 1.0, ""});
}
BEAST(throw_number) { throw 42; }
BEAST(throw_long_text) { throw std::runtime_error(std::string(20 << 20, 'x')); }
BEAST(throw_bad_alloc) { throw std::bad_alloc(); }

}  // namespace
}  // namespace loopbench::zoo
