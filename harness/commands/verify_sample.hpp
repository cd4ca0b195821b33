/// Recomputation of a sample of stored cells.
#pragma once

#include <filesystem>
#include <string>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

struct SampleArguments {
  double share = 0.0;           ///< of the stored cells, 0..1
  std::filesystem::path store;  ///< folder of results
  std::string only;             ///< regular expression
  int jobs = 1;
};

/// Recomputes a share of the cells of a store, at least one, and compares them bit by bit. The
/// sample is the same for every call. Prints the differences; returns the exit code. Throws
/// InputError if the store has no cell of this sweep and build.
int verify_sample(const Sweep& sweep,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  const std::string& build,
                  const SampleArguments& arguments);

}  // namespace loopbench::harness
