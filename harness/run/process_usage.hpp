/// Resource usage of this process as reported by the system.
#pragma once

#include <cstdint>
#include <optional>

namespace loopbench::harness {

/// CPU time of all threads of the process [s].
double process_cpu_seconds();

/// Resets the largest resident size, so that peak_memory() covers the time from now on. False if
/// the system does not support it.
bool reset_peak_memory();

/// Declares that this process was just forked to run one method: its peak needs no reset.
void set_freshly_forked();

bool is_freshly_forked();

/// Largest resident size since the reset or the start of the process [bytes].
std::optional<std::int64_t> peak_memory();

}  // namespace loopbench::harness
