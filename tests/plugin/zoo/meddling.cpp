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

void round_upward(const Scene&) { std::fesetround(FE_UPWARD); }
void flush_denormals(const Scene&) {
#ifdef __SSE2__
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
#endif
}
void trap_division(const Scene&) { feenableexcept(FE_DIVBYZERO); }
void change_input(const Scene& scene) {
  const_cast<Problem&>(scene.problem).keyframes.back().world_from_body.translation.x() += 1.0;
}
void change_directory(const Scene&) { require(chdir("/"), "chdir"); }
void change_umask(const Scene&) { umask(0777); }
void change_environment(const Scene&) {
  setenv("OMP_NUM_THREADS", "7", 1);
  setenv("LC_ALL", "de_DE.UTF-8", 1);
}
void change_locale(const Scene&) { std::setlocale(LC_ALL, "C.UTF-8"); }
void ignore_signals(const Scene&) {
  for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_IGN);
}
void set_alarm(const Scene&) { alarm(20); }
void leave_threads(const Scene&) {
  for (int i = 0; i < 4; ++i) std::thread([] { pause(); }).detach();
}
void close_all(const Scene&) {
  for (int file = 0; file < 1024; ++file) close(file);
}
void write_to_descriptors(const Scene&) {
  const std::string noise(4096, 'x');
  for (int file = 3; file < 64; ++file) {
    [[maybe_unused]] const ssize_t written = write(file, noise.data(), noise.size());
  }
}
/// All memory that this process shares with others.
void write_to_shared_memory(const Scene&) {
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

std::vector<methods::MethodEntry> meddling() {
  return {beast<round_upward>("round_upward"),
          beast<flush_denormals>("flush_denormals"),
          beast<trap_division>("trap_division"),
          beast<change_input>("change_input"),
          beast<change_directory>("change_directory"),
          beast<change_umask>("change_umask"),
          beast<change_environment>("change_environment"),
          beast<change_locale>("change_locale"),
          beast<ignore_signals>("ignore_signals"),
          beast<set_alarm>("set_alarm"),
          beast<leave_threads>("leave_threads"),
          beast<close_all>("close_all"),
          beast<write_to_descriptors>("write_to_descriptors"),
          beast<write_to_shared_memory>("write_to_shared_memory")};
}

}  // namespace loopbench::zoo
