/// Methods that end their process.
#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <csetjmp>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

BEAST(segfault) {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;
}
BEAST(abort_now) { std::abort(); }
BEAST(abort_in_thread) {
  std::thread([] { std::abort(); }).join();
}
/// Another method's cell must not pay for it.
BEAST(abort_later) {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::seconds(20));
    std::abort();
  }).detach();
}
BEAST(exit_3) { std::exit(3); }
BEAST(exit_quietly) { _exit(0); }
BEAST(kill_itself) { raise(SIGKILL); }

volatile int bottom = -1;
int recursion(int depth) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth == bottom ? 0 : recursion(depth + 1) + frame[0];
}
BEAST(overflow_stack) { scene.report.count("depth", recursion(1)); }

std::jmp_buf start;
void leave_frames() {
  const std::vector<int> lost(1000);
  std::longjmp(start, 1);
}
BEAST(long_jump) {
  if (setjmp(start) == 0) leave_frames();
}

/// As if it were unloaded while it runs.
BEAST(unmap_itself) {
  const auto code = reinterpret_cast<std::uintptr_t>(&unmap_itself);
  munmap(reinterpret_cast<void*>(code / 4096 * 4096), 8192);
}
BEAST(unload_itself) {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&unload_itself), &info) == 0) return;
  void* self = dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD);
  if (self != nullptr) dlclose(self);
}

}  // namespace
}  // namespace loopbench::zoo
