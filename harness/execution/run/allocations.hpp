/// Number of memory allocations of the program.
#pragma once

#include <cstdint>
#include <optional>

namespace loopbench::harness {

using AllocationCounter = std::int64_t (*)();

/// Sets the function that counts allocations, before any thread starts; null: they are not counted.
void set_allocation_counter(AllocationCounter counter);

/// Calls by all threads so far; nullopt where they are not counted.
std::optional<std::int64_t> allocations();

}  // namespace loopbench::harness
