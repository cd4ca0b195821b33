#include "harness/execution/isolate/process_state.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace loopbench::harness {
namespace {

std::vector<std::string> environment_now() {
  std::vector<std::string> out;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    out.emplace_back(*entry);
  }
  return out;
}

mode_t file_mode_mask() {
  const mode_t out = umask(0);
  umask(out);
  return out;
}

}  // namespace

ProcessState::ProcessState()
    : mask_(file_mode_mask()),
      folder_(open(".", O_PATH | O_DIRECTORY | O_CLOEXEC)),
      locale_(std::setlocale(LC_ALL, nullptr)),
      environment_(environment_now()) {
  for (int signal = 1; signal < NSIG; ++signal) {
    sigaction(signal, nullptr, &actions_[static_cast<std::size_t>(signal)]);
  }
  sigprocmask(SIG_SETMASK, nullptr, &blocked_);
}

ProcessState::~ProcessState() {
  for (int signal = 1; signal < NSIG; ++signal) {
    sigaction(signal, &actions_[static_cast<std::size_t>(signal)], nullptr);
  }
  sigprocmask(SIG_SETMASK, &blocked_, nullptr);
  umask(mask_);
  [[maybe_unused]] const int moved = fchdir(folder_);  // it may have been removed
  close(folder_);
  std::setlocale(LC_ALL, locale_.c_str());
  if (environment_now() == environment_) return;
  clearenv();
  for (const std::string& entry : environment_) {
    const std::size_t name = entry.find('=');
    if (name == std::string::npos) continue;
    setenv(entry.substr(0, name).c_str(), entry.c_str() + name + 1, 1);
  }
}

}  // namespace loopbench::harness
