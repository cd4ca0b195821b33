#include "harness/run/process_usage.hpp"

#include <sys/resource.h>

#include <ctime>

#include "harness/base/system_file.hpp"

namespace loopbench::harness {
namespace {

bool freshly_forked = false;

}  // namespace

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void set_freshly_forked() { freshly_forked = true; }

bool is_freshly_forked() { return freshly_forked; }

bool reset_peak_memory() {
  if (freshly_forked) return true;
  return write_system_file("/proc/self/clear_refs", "5");  // proc(5): resets VmHWM
}

std::optional<std::int64_t> peak_memory() {
  if (!freshly_forked) return memory_in(read_system_file("/proc/self/status"), "VmHWM:");
  rusage usage{};  // faster; of an older process it would cover the time before the reset
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

}  // namespace loopbench::harness
