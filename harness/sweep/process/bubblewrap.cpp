#include "harness/sweep/process/bubblewrap.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <system_error>

#include "harness/sweep/process/child_process.hpp"

namespace loopbench::harness {
namespace {

/// Devices that compute. All of /dev would let root leave files there.
std::vector<std::string> computing_devices() {
  constexpr std::array<const char*, 5> kNames{"dri", "nvidia", "kfd", "accel", "dxg"};
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const std::string name = entry.path().filename().string();
    if (std::ranges::none_of(kNames, [&](const char* each) { return name.starts_with(each); }))
      continue;
    if (entry.is_character_file(error)) out.push_back(entry.path().string());
    for (const auto& device : std::filesystem::directory_iterator(entry.path(), error))
      if (device.is_character_file(error)) out.push_back(device.path().string());
  }
  return out;
}

}  // namespace

// Without a user namespace of its own, programs of root share keys of the kernel; root could also
// write settings of the kernel.
std::vector<std::string> bubblewrap_arguments(bool network) {
  std::istringstream words(
      "bwrap --die-with-parent --new-session --unshare-user-try --unshare-pid --unshare-ipc "
      "--cap-drop ALL --ro-bind / / --dev /dev --proc /proc --ro-bind-try /proc/sys /proc/sys");
  std::vector<std::string> out{std::istream_iterator<std::string>(words), {}};
  for (const std::string& each : computing_devices())
    out.insert(out.end(), {"--dev-bind-try", each, each});
  if (!network) out.emplace_back("--unshare-net");
  return out;
}

namespace {

bool run_bubblewrap(bool network) {
  ProgramCall call;
  call.arguments = bubblewrap_arguments(network);
  call.arguments.insert(call.arguments.end(), {"--", "true"});
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  call.output = call.errors = null;
  bool out = false;
  try {
    out = ChildProcess(ProcessGroup::own, call).exit_code() == 0;
  } catch (const std::runtime_error&) {  // it is not installed
  }
  close(null);
  return out;
}

}  // namespace

bool can_hide_network() {
  static const bool out = run_bubblewrap(false);
  return out;
}

bool has_bubblewrap() {
  static const bool out = can_hide_network() || run_bubblewrap(true);
  return out;
}

}  // namespace loopbench::harness
