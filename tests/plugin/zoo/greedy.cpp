/// Methods that use memory and write output without end.
#include <unistd.h>

#include <cstdio>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

constexpr std::size_t kBlock = std::size_t{16} << 20;  // [bytes]

void allocate(int blocks) {
  for (int i = 0; i < blocks; ++i) {
    char* volatile lost = new char[kBlock];  // volatile: compilers leave out unused allocations
    std::memset(lost, i, kBlock);
  }
}

BEAST(leak) { allocate(2); }
/// Bounded, in case nothing else ends it.
BEAST(allocate_without_end) { allocate(128); }
/// In a process of its own, which the limit covers as well.
BEAST(allocate_in_child) {
  if (fork() == 0) {
    allocate(128);
    for (;;) pause();
  }
  for (;;) pause();
}
BEAST(flood_output) {
  const std::string line(1 << 16, '.');
  for (int i = 0; i < 4096; ++i) std::fputs(line.c_str(), stdout);
}
BEAST(flood_errors) {
  const std::string line(1 << 16, '.');
  for (;;) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
  }
}

}  // namespace
}  // namespace loopbench::zoo
