#pragma once

namespace loopbench {

/// From CMake's project(VERSION).
inline constexpr const char* kVersion = LOOPBENCH_VERSION;

}  // namespace loopbench
