/// Header for shared objects outside this repository that provide methods, datasets and metrics.
#pragma once

#include <variant>
#include <vector>

#include "datasets/dataset.hpp"
#include "harness/plugin/function_method.hpp"
#include "methods/method.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

using PluginEntry = std::variant<methods::MethodEntry, DatasetEntry, metrics::MetricEntry>;

/// Properties that must be equal in both binaries before they exchange our types. `interface` stays
/// the first member: it is read before the others, whose meaning depends on it.
struct Abi {
  int interface = 6;  ///< raise when this file or the headers that it includes change shape
  long language = __cplusplus;
  int standard_library = _GLIBCXX_RELEASE;  ///< GCC and clang with the same one fit together
  int eigen = EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION;
  int eigen_alignment = EIGEN_MAX_ALIGN_BYTES;  ///< differs when one side used -march=native
  int string_size = sizeof(std::string);        ///< differs under another standard library ABI
  int problem_size = sizeof(Problem);
  int sequence_size = sizeof(Sequence);
  int evaluation_size = sizeof(metrics::Evaluation);
  int score_size = sizeof(metrics::Score);
  int method_size = sizeof(methods::MethodEntry);
  int dataset_size = sizeof(DatasetEntry);
  int metric_size = sizeof(metrics::MetricEntry);

  bool operator==(const Abi&) const = default;
};

struct Plugin {
  Abi abi;
  std::vector<PluginEntry> (*entries)();
};

}  // namespace loopbench::harness

/// Exports the entries of a plugin: LOOPBENCH_PLUGIN(method<Mine>("mine", "what it computes"),
/// dataset<Options>("name", "what it reads", load), metric<Options>("name", "what it measures",
/// score))
#define LOOPBENCH_PLUGIN(...)                                               \
  extern "C" const void* loopbench_plugin() {                               \
    static const loopbench::harness::Plugin plugin{                         \
        {}, [] {                                                            \
          using namespace loopbench;          /* dataset */                 \
          using namespace loopbench::methods; /* method */                  \
          using namespace loopbench::metrics; /* metric */                  \
          return std::vector<loopbench::harness::PluginEntry>{__VA_ARGS__}; \
        }};                                                                 \
    return &plugin;                                                         \
  }
