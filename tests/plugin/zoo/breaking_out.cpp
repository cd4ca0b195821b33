#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

void open_socket(const Scene&) { require(socket(AF_INET, SOCK_DGRAM, 0), "socket"); }
void trace_parent(const Scene&) {
  require(ptrace(PTRACE_ATTACH, getppid(), nullptr, nullptr), "ptrace");
}
void read_file(const Scene& scene) { require(open(scene.path.c_str(), O_RDONLY), "open"); }
void write_file(const Scene& scene) {
  require(open((scene.path + ".zoo").c_str(), O_WRONLY | O_CREAT, 0600), "create");
}

void share_memory(const Scene&) { require(shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600), "shmget"); }
void open_local_socket(const Scene&) { require(socket(AF_UNIX, SOCK_STREAM, 0), "socket"); }
/// The worker would keep the priority for all its later cells.
void slow_parent(const Scene&) {
  require(setpriority(PRIO_PROCESS, static_cast<id_t>(getppid()), 19), "setpriority");
}
void change_mode(const Scene& scene) { require(chmod(scene.path.c_str(), 0), "chmod"); }

}  // namespace

std::vector<methods::MethodEntry> breaking_out() {
  return {beast<open_socket>("open_socket"),
          beast<trace_parent>("trace_parent"),
          beast<read_file>("read_file"),
          beast<read_file>("read_other_results"),
          beast<open_local_socket>("open_local_socket"),
          beast<slow_parent>("slow_parent"),
          beast<write_file>("write_file"),
          beast<share_memory>("share_memory"),
          beast<change_mode>("change_mode")};
}

}  // namespace loopbench::zoo
