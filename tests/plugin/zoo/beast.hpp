/// Methods that return the keyframes, after a deed that they should not do.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/catalogue/plugin.hpp"

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

/// Name and deed, for the list of methods.
template <void (*deed)(const Scene&)>
methods::MethodEntry beast(const std::string& name) {
  return methods::method<Beast<deed>>(name, "misbehaves");
}

/// Throws with the reason of the system if a call failed.
inline void require(long result, const char* call) {
  if (result < 0) throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
}

std::vector<methods::MethodEntry> crashing();  ///< end their process
std::vector<methods::MethodEntry> hanging();   ///< never return
std::vector<methods::MethodEntry> breeding();  ///< start or signal other processes
std::vector<methods::MethodEntry> meddling();  ///< change the state of their process
std::vector<methods::MethodEntry> greedy();    ///< memory and output without end
std::vector<methods::MethodEntry> lying();     ///< return or throw what they should not

}  // namespace loopbench::zoo
