/// Header for shared objects outside this repository that provide methods, datasets and metrics.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "datasets/dataset.hpp"
#include "methods/function_method.hpp"
#include "methods/method.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

using PluginEntry = std::variant<methods::MethodEntry, DatasetEntry, metrics::MetricEntry>;

/// Properties that must be equal in both binaries before they exchange our types. `interface` stays
/// the first member: it is read before the others, whose meaning depends on it.
struct Abi {
  int interface = 14;  ///< raise when this file or the headers that it includes change shape
  struct Property {
    const char* name;
    long value;
  };
  std::array<Property, 15> properties{{
      {"__cplusplus", __cplusplus},
      {"_GLIBCXX_RELEASE", _GLIBCXX_RELEASE},  // GCC and clang with the same one fit together
      {"EIGEN_WORLD_VERSION", EIGEN_WORLD_VERSION},
      {"EIGEN_MAJOR_VERSION", EIGEN_MAJOR_VERSION},
      {"EIGEN_MINOR_VERSION", EIGEN_MINOR_VERSION},
      {"EIGEN_MAX_ALIGN_BYTES", EIGEN_MAX_ALIGN_BYTES},  // differs when one side has -march=native
      {"sizeof(std::string)", sizeof(std::string)},      // differs under _GLIBCXX_USE_CXX11_ABI=0
      {"sizeof(Problem)", sizeof(Problem)},
      {"sizeof(Sequence)", sizeof(Sequence)},
      {"sizeof(Evaluation)", sizeof(metrics::Evaluation)},
      {"sizeof(Score)", sizeof(metrics::Score)},
      {"sizeof(Report)", sizeof(methods::Report)},
      {"sizeof(MethodEntry)", sizeof(methods::MethodEntry)},
      {"sizeof(DatasetEntry)", sizeof(DatasetEntry)},
      {"sizeof(MetricEntry)", sizeof(metrics::MetricEntry)},
  }};
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
