#include "harness/execution/run/allocations.hpp"

namespace loopbench::harness {
namespace {

AllocationCounter allocation_counter = nullptr;

}  // namespace

void set_allocation_counter(AllocationCounter counter) { allocation_counter = counter; }

std::optional<std::int64_t> allocations() {
  if (allocation_counter == nullptr) return std::nullopt;
  return allocation_counter();
}

}  // namespace loopbench::harness
