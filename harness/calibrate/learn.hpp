/// Calibration of noise models on the sequences of a sweep.
#pragma once

#include <string>

#include "harness/calibrate/calibration_text.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

struct LearnOptions {
  std::string train;       ///< a Pattern: only datasets whose label contains a match
  std::size_t every = 10;  ///< consecutive edges combined into one
  int draws = 50;          ///< bootstrap samples
};

/// Throws InputError if no dataset matches, none is long enough, or a file is missing or invalid.
Calibration learn(const Sweep& sweep,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  const LearnOptions& options);

}  // namespace loopbench::harness
