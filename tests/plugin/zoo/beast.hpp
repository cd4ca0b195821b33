/// Methods that return the keyframes, after a deed that they should not do.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/sweep/catalogue/plugin.hpp"

namespace loopbench::zoo {

struct Options {};
template <class Visit>
void fields(Options&, Visit) {}

struct Scene {
  const Problem& problem;
  Trajectory& estimate;
  methods::Report& report;
};

template <void (*deed)(const Scene&)>
struct Beast final : methods::Corrector {
  using Options = zoo::Options;
  explicit Beast(const Options&) {}
  Trajectory correct(const Problem& problem, methods::Report& report) const override {
    Trajectory estimate = problem.keyframes;
    deed({problem, estimate, report});
    return estimate;
  }
};

/// The methods of all files, listed by BEAST.
std::vector<harness::PluginEntry>& beasts();

/// Defines a deed and lists the method of that name.
#define BEAST(deed)                                                                     \
  void deed(const Scene& scene);                                                        \
  [[maybe_unused]] const bool deed##_is_listed =                                        \
      (beasts().emplace_back(methods::method<Beast<deed>>(#deed, "misbehaves")), true); \
  void deed([[maybe_unused]] const Scene& scene)

/// Throws with the reason of the system if a call failed.
inline void require(long result, const char* call) {
  if (result < 0) throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
}

}  // namespace loopbench::zoo
