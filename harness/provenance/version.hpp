#pragma once

namespace loopbench {

/// Version of CMake's project().
inline constexpr const char* kVersion = LOOPBENCH_VERSION;

}  // namespace loopbench
