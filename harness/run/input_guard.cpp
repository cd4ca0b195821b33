#include "harness/run/input_guard.hpp"

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

Hash content_of(const Inputs& inputs) {
  Hash out;
  for (const std::string_view bytes : inputs) {
    const Hash next = hash_of(bytes);
    out.low = out.low * 31 + next.low;
    out.high = out.high * 31 + next.high;
  }
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

Inputs inputs_of(const Problem& problem) {
  return {bytes_in_memory(problem.keyframes),
          bytes_in_memory(problem.odometry),
          bytes_in_memory(problem.closures),
          bytes_in_memory(problem.frames),
          bytes_in_memory(problem.shared_landmarks),
          {reinterpret_cast<const char*>(&problem.planar), sizeof problem.planar}};
}

Inputs inputs_of(const metrics::Evaluation& evaluation) {
  const metrics::Context& context = evaluation.context;
  Inputs out = context.problem != nullptr ? inputs_of(*context.problem) : Inputs();
  const auto add = [&](const Trajectory* poses) {
    if (poses != nullptr) out.push_back(bytes_in_memory(*poses));
  };
  add(&evaluation.reference);
  add(&evaluation.estimate);
  add(context.reference);
  add(context.estimate);
  return out;
}

InputGuard::InputGuard(Inputs inputs) : inputs_(std::move(inputs)), content_(content_of(inputs_)) {
  std::fegetenv(&mode_);
}

InputGuard::~InputGuard() { std::fesetenv(&mode_); }

std::string InputGuard::fault() const {
  if (control_bits() != control_bits_of(mode_)) {
    return "changed the floating-point mode (rounding, traps or denormals)";
  }
  return content_of(inputs_) == content_ ? "" : "changed its input";
}

}  // namespace loopbench::harness
