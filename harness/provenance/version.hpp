#pragma once

namespace loopbench::harness {

/// Version of CMake's project().
inline constexpr const char* kVersion = LOOPBENCH_VERSION;

}  // namespace loopbench::harness
