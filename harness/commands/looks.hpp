/// When and by which program a claim was looked at.
#pragma once

#include <fmt/chrono.h>

#include <ctime>
#include <string>

#include "harness/run/collect_provenance.hpp"

namespace loopbench::harness {

/// The date in UTC, "2026-11-25".
inline std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

/// "a9736e1dc55d", or "a9736e1dc55d, dirty".
inline std::string commit_of(const Source& source) {
  const std::string commit = source.commit.substr(0, 12);
  return source.state == "clean" ? commit : commit + ", " + source.state;
}

}  // namespace loopbench::harness
