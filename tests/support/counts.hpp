// Counts reported by a method: iterations, kinks, segments ...
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "methods/report.hpp"

namespace loopbench::test {

using namespace methods;

/// The count of that name; fails the test if there is none.
inline double count(const Report& report, const std::string& name) {
  for (const Count& each : report.counts) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << "no count " << name;
  return std::nan("");
}

}  // namespace loopbench::test
