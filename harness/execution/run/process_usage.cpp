#include "harness/execution/run/process_usage.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

namespace loopbench::harness {
namespace {

bool freshly_forked = false;

/// Reads the number of kilobytes after `name` in /proc/self/status; returns bytes.
std::optional<std::int64_t> from_status(std::string_view name) {
  const int file = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  char text[4096];
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  if (size <= 0) return std::nullopt;
  text[size] = '\0';
  const char* found = std::strstr(text, name.data());
  if (found == nullptr) return std::nullopt;
  return 1024 * std::int64_t{std::strtoll(found + name.size(), nullptr, 10)};
}

}  // namespace

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::optional<std::int64_t> resident_memory() { return from_status("VmRSS:"); }

std::optional<std::int64_t> data_memory() { return from_status("VmData:"); }

void set_freshly_forked() { freshly_forked = true; }

bool is_freshly_forked() { return freshly_forked; }

bool reset_peak_memory() {
  if (freshly_forked) return true;
  const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool done = write(file, "5", 1) == 1;  // proc(5): resets VmHWM
  close(file);
  return done;
}

std::optional<std::int64_t> peak_memory() { return from_status("VmHWM:"); }

}  // namespace loopbench::harness
