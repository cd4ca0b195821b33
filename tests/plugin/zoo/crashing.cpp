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

void segfault(const Scene&) {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;
}
void abort_now(const Scene&) { std::abort(); }
void abort_in_thread(const Scene&) {
  std::thread([] { std::abort(); }).join();
}
/// Another method's cell must not pay for it.
void abort_later(const Scene&) {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::seconds(20));
    std::abort();
  }).detach();
}
void exit_3(const Scene&) { std::exit(3); }
void exit_quietly(const Scene&) { _exit(0); }
void kill_itself(const Scene&) { raise(SIGKILL); }
void bad_instruction(const Scene&) { __builtin_trap(); }
void divide_by_zero(const Scene&) { raise(SIGFPE); }
void escaped_exception(const Scene&) {
  std::thread([] { throw 1; }).join();
}

volatile int bottom = -1;
int recursion(int depth) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth == bottom ? 0 : recursion(depth + 1) + frame[0];
}
void overflow_stack(const Scene& scene) { scene.report.count("depth", recursion(1)); }

std::jmp_buf start;
void leave_frames() {
  const std::vector<int> lost(1000);
  std::longjmp(start, 1);
}
void long_jump(const Scene&) {
  if (setjmp(start) == 0) leave_frames();
}

/// As if it were unloaded while it runs.
void unmap_itself(const Scene&) {
  const auto code = reinterpret_cast<std::uintptr_t>(&unmap_itself);
  munmap(reinterpret_cast<void*>(code / 4096 * 4096), 8192);
}
void unload_itself(const Scene&) {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&unload_itself), &info) == 0) return;
  void* self = dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD);
  if (self != nullptr) dlclose(self);
}

}  // namespace

std::vector<methods::MethodEntry> crashing() {
  return {beast<segfault>("segfault"),
          beast<abort_now>("abort_now"),
          beast<abort_in_thread>("abort_in_thread"),
          beast<abort_later>("abort_later"),
          beast<exit_3>("exit_3"),
          beast<exit_quietly>("exit_quietly"),
          beast<kill_itself>("kill_itself"),
          beast<bad_instruction>("bad_instruction"),
          beast<divide_by_zero>("divide_by_zero"),
          beast<escaped_exception>("escaped_exception"),
          beast<overflow_stack>("overflow_stack"),
          beast<long_jump>("long_jump"),
          beast<unmap_itself>("unmap_itself"),
          beast<unload_itself>("unload_itself")};
}

}  // namespace loopbench::zoo
