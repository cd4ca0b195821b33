/// Methods that change the state of their process.
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

BEAST(round_upward) { std::fesetround(FE_UPWARD); }
BEAST(flush_denormals) {
#ifdef __SSE2__
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
#endif
}
BEAST(trap_division) { feenableexcept(FE_DIVBYZERO); }
BEAST(change_input) {
  const_cast<Problem&>(scene.problem).keyframes.back().world_from_body.translation.x() += 1.0;
}
BEAST(change_directory) { require(chdir("/"), "chdir"); }
BEAST(change_umask) { umask(0777); }
BEAST(change_environment) {
  setenv("OMP_NUM_THREADS", "7", 1);
  setenv("LC_ALL", "de_DE.UTF-8", 1);
}
BEAST(change_locale) { std::setlocale(LC_ALL, "C.UTF-8"); }
BEAST(ignore_signals) {
  for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_IGN);
}
BEAST(set_alarm) { alarm(20); }
BEAST(leave_threads) {
  for (int i = 0; i < 4; ++i) std::thread([] { pause(); }).detach();
}
BEAST(close_all) {
  for (int file = 0; file < 1024; ++file) close(file);
}
BEAST(write_to_descriptors) {
  const std::string noise(4096, 'x');
  for (int file = 3; file < 64; ++file) {
    [[maybe_unused]] const ssize_t written = write(file, noise.data(), noise.size());
  }
}
/// All memory that this process shares with others.
BEAST(write_to_shared_memory) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    unsigned long begin = 0;
    unsigned long end = 0;
    char rights[5] = {};
    if (std::sscanf(line.c_str(), "%lx-%lx %4s", &begin, &end, rights) != 3) continue;
    if (rights[1] != 'w' || rights[3] != 's') continue;
    std::memset(reinterpret_cast<void*>(begin), 0x5a, std::min(end - begin, 1ul << 16));
  }
}

}  // namespace
}  // namespace loopbench::zoo
