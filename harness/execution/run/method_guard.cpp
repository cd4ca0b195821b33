#include "harness/execution/run/method_guard.hpp"

#include <stdexcept>
#include <string_view>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace loopbench::harness {
namespace {

/// The bytes in memory, with padding: it is compared with itself.
template <class T>
std::string_view bytes_in_memory(const std::vector<T>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
}

Hash content_of(const Problem& problem) {
  Hash out = hash_of(bytes_in_memory(problem.keyframes));
  for (const std::string_view bytes : {bytes_in_memory(problem.odometry),
                                       bytes_in_memory(problem.closures),
                                       bytes_in_memory(problem.frames),
                                       bytes_in_memory(problem.shared_landmarks)}) {
    const Hash next = hash_of(bytes);
    out.low = out.low * 31 + next.low;
    out.high = out.high * 31 + next.high;
  }
  out.low += problem.planar ? 1 : 0;
  return out;
}

/// Rounding, traps and treatment of denormals; not the flags, which every operation sets.
unsigned control_bits() {
  unsigned out = static_cast<unsigned>(std::fegetround());
#ifdef __SSE2__
  constexpr unsigned kFlags = 0x3f;
  out = (out << 16) | (_mm_getcsr() & ~kFlags);
#endif
  return out;
}

unsigned control_bits_of(const std::fenv_t& mode) {
  std::fenv_t now;
  std::fegetenv(&now);
  std::fesetenv(&mode);
  const unsigned out = control_bits();
  std::fesetenv(&now);
  return out;
}

}  // namespace

MethodGuard::MethodGuard(const Problem& problem)
    : problem_(problem), content_(content_of(problem)) {
  std::fegetenv(&mode_);
}

MethodGuard::~MethodGuard() { std::fesetenv(&mode_); }

void MethodGuard::require_unchanged() const {
  if (control_bits() != control_bits_of(mode_)) {
    std::fesetenv(&mode_);
    throw std::runtime_error("changed the floating-point mode (rounding, traps or denormals)");
  }
  if (content_of(problem_) != content_) throw std::runtime_error("changed its input");
}

}  // namespace loopbench::harness
