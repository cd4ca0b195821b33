/// What this process has used so far, as the system counts it.
#pragma once

#include <cstdint>
#include <optional>

namespace loopbench {

/// CPU time of all threads of the process [s].
double process_cpu_seconds();

/// Resident size now [bytes]; nothing where /proc is not.
std::optional<std::int64_t> resident_memory();

/// Forgets the largest resident size so far, so that peak_memory() tells what comes. False where
/// the system cannot.
bool forget_peak_memory();

/// Largest resident size since then, or since the process began [bytes].
std::optional<std::int64_t> peak_memory();

}  // namespace loopbench
