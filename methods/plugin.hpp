/// Header for shared objects outside this repository that provide methods.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Properties that must be equal in both binaries before they exchange our types. `interface` stays
/// the first member: it is read before the others, whose meaning depends on it.
struct Abi {
  int interface = 2;  ///< raise when this file, method.hpp or datasets/core changes shape
  long language = __cplusplus;
  int compiler = __GNUC__;
#ifdef __clang__
  int clang = __clang_major__;
#else
  int clang = 0;
#endif
  int eigen = EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION;
  int eigen_alignment = EIGEN_MAX_ALIGN_BYTES;  ///< differs when one side used -march=native
  int string_size = sizeof(std::string);        ///< differs under another standard library ABI
  int problem_size = sizeof(Problem);
  int entry_size = sizeof(MethodEntry);

  bool operator==(const Abi&) const = default;
};

struct Plugin {
  Abi abi;
  std::vector<MethodEntry> (*methods)();
};

}  // namespace loopbench::methods

/// Exports the methods of a plugin: LOOPBENCH_PLUGIN(method<Mine>("mine", "what it computes"))
#define LOOPBENCH_PLUGIN(...)                                                          \
  extern "C" const loopbench::methods::Plugin* loopbench_plugin() {                    \
    static const loopbench::methods::Plugin plugin{                                    \
        {}, [] { return std::vector<loopbench::methods::MethodEntry>{__VA_ARGS__}; }}; \
    return &plugin;                                                                    \
  }
