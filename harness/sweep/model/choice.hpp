/// A dataset, method or metric that a sweep uses, with options.
#pragma once

#include <string>

#include "datasets/core/params.hpp"

namespace loopbench::harness {

/// A catalogue name and the options that differ from its defaults.
struct Choice {
  std::string name;
  Params options;

  friend bool operator==(const Choice&, const Choice&) = default;
};

}  // namespace loopbench::harness
