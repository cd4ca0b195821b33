#include <unistd.h>

#include <cstdio>
#include <memory>

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

void leak(const Scene&) { allocate(2); }
/// Bounded, in case nothing else ends it.
void allocate_without_end(const Scene&) { allocate(128); }
/// In a process of its own, which the limit covers as well.
void allocate_in_child(const Scene&) {
  if (fork() == 0) {
    allocate(128);
    for (;;) pause();
  }
  for (;;) pause();
}
void flood_output(const Scene&) {
  const std::string line(1 << 16, '.');
  for (int i = 0; i < 4096; ++i) std::fputs(line.c_str(), stdout);
}
void flood_errors(const Scene&) {
  const std::string line(1 << 16, '.');
  for (;;) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
  }
}

}  // namespace

std::vector<methods::MethodEntry> greedy() {
  return {beast<leak>("leak"),
          beast<allocate_without_end>("allocate_without_end"),
          beast<allocate_in_child>("allocate_in_child"),
          beast<flood_output>("flood_output"),
          beast<flood_errors>("flood_errors")};
}

}  // namespace loopbench::zoo
