/// Programs of seccomp that find the rule of a system call by bisection.
#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <vector>

namespace loopbench::harness {

/// What is done for one system call: instructions that end with a return.
struct CallRule {
  std::uint32_t number = 0;
  std::vector<sock_filter> code;
};

/// The table of system calls that a program is for.
struct CallTable {
  std::uint32_t architecture = 0;  ///< AUDIT_ARCH_...
  std::uint32_t excluded = 0;      ///< bits of numbers of another table, or 0
};

/// Program that returns `refused` for calls of other tables, follows the rules, and permits all
/// other calls. One rule at most for each number. O(n log n); the program takes O(log n) steps:
/// the kernel runs it for every number when it is installed, which happens for every cell.
std::vector<sock_filter> filter_program(const CallTable& table,
                                        std::uint32_t refused,
                                        std::vector<CallRule> rules);

}  // namespace loopbench::harness
