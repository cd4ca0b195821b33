#include "harness/sweep/process/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "harness/sweep/process/descendants.hpp"

namespace loopbench::harness {
namespace {

/// Variables that programs must not see: they lead to the data and the references.
constexpr std::array<std::string_view, 2> kHidden{"LOOPBENCH_DATA=", "LOOPBENCH_CACHE="};

std::vector<std::string> environment_of(const ProgramStart& start) {
  std::vector<std::string> out;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view variable(*each);
    bool is_kept = true;
    for (const std::string_view hidden : kHidden) is_kept &= !variable.starts_with(hidden);
    for (const auto& [name, value] : start.environment) {
      is_kept &= !variable.starts_with(name + "=");
    }
    if (is_kept) out.emplace_back(variable);
  }
  for (const auto& [name, value] : start.environment) out.push_back(name + "=" + value);
  return out;
}

/// Whether the program exists; otherwise bubblewrap would report that it does not.
bool is_executable(const ProgramStart& start) {
  const std::string& name = start.arguments.front();
  if (name.find('/') != std::string::npos) return access((start.folder / name).c_str(), X_OK) == 0;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/bin:/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

/// With the command line of the sandbox, or without a sandbox if there is none.
ProgramStart with_sandbox(ProgramStart start) {
  const bool is_used = start.sandbox != nullptr && start.sandbox->enabled && is_executable(start) &&
                       has_bubblewrap();
  if (!is_used) {
    start.sandbox = nullptr;
    return start;
  }
  start.arguments = sandboxed_arguments(
      *start.sandbox,
      {start.arguments, start.folder, start.readable, start.writable, start.network});
  return start;
}

/// Two ends that are closed unless they are taken.
class Ends {
 public:
  explicit Ends(bool is_socket = false) {
    const int failed = is_socket ? socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data())
                                 : pipe2(ends_.data(), O_CLOEXEC);
    if (failed != 0) {
      throw std::runtime_error(std::string("cannot start a program: ") + std::strerror(errno));
    }
  }
  ~Ends() {
    for (const int end : ends_) {
      if (end >= 0) close(end);
    }
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;

  int operator[](std::size_t i) const { return ends_[i]; }
  int take(std::size_t i) { return std::exchange(ends_[i], -1); }

 private:
  std::array<int, 2> ends_{-1, -1};
};

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

void do_not_block(int file) { fcntl(file, F_SETFL, fcntl(file, F_GETFL) | O_NONBLOCK); }

}  // namespace

RunningProgram::RunningProgram(const ProgramStart& given) {
  const ProgramStart start = with_sandbox(given);
  is_sandboxed_ = start.sandbox != nullptr;
  Ends output;
  Ends input(true);
  Ends errors;
  constexpr int kPipeSize = 1 << 20;  // [bytes], so that a problem is passed in one piece
  fcntl(output[1], F_SETPIPE_SZ, kPipeSize);
  for (const int end : {input[0], input[1]}) {
    setsockopt(end, SOL_SOCKET, SO_SNDBUF, &kPipeSize, sizeof kPipeSize);
  }
  ProgramCall call;
  call.arguments = start.arguments;
  call.folder = start.folder;
  call.environment = environment_of(start);
  call.input = start.serves ? input[1] : -1;
  call.output = output[1];
  call.errors = start.serves ? errors[1] : output[1];
  if (start.shows_errors) call.errors = -1;
  try {
    process_.emplace(ProcessGroup::own, call);
  } catch (const std::system_error& error) {
    if (error.code().value() == EAGAIN) {
      throw std::runtime_error("cannot start a program: no processes left");
    }
    start_error_ = error.code().value();
  }
  output_ = output.take(0);
  do_not_block(output_);
  if (!start.serves) return;
  input_ = input.take(0);
  errors_ = errors.take(0);
  do_not_block(input_);
  do_not_block(errors_);
}

RunningProgram::~RunningProgram() {
  for (const int file : {input_, output_, errors_}) {
    if (file >= 0) close(file);
  }
}

bool RunningProgram::has_ended() const { return !process_ || process_->has_ended(); }

ProgramEnd RunningProgram::wait(std::string& output,
                                const std::function<void(const std::string&)>& tick) {
  ProgramEnd end;
  TreeCost cost;
  end.start_error = start_error_;
  bool is_open = process_.has_value();
  while (!has_ended()) {
    std::array<pollfd, 3> files{{{process_->descriptor(), POLLIN, 0},
                                 {is_open ? output_ : -1, POLLIN, 0},
                                 {errors_, POLLIN, 0}}};
    // Bubblewrap does not wait for the processes in it, so that their usage is not in its own.
    if (is_sandboxed_) {
      const TreeCost now = tree_cost(process_->id());
      cost.cpu_seconds = std::max(cost.cpu_seconds, now.cpu_seconds);
      cost.peak_memory = std::max(cost.peak_memory, now.peak_memory);
    }
    if (tick) tick(output);
    constexpr int kBetweenSamples = 10, kBetweenTicks = 200;  // [ms]
    const int unsandboxed = tick ? kBetweenTicks : -1;
    const int longest = is_sandboxed_ ? kBetweenSamples : unsandboxed;
    if (poll(files.data(), files.size(), longest) < 0) continue;
    if (files[1].revents != 0) is_open = read_available(output_, output);
    if (files[2].revents != 0) read_available(errors_, output);
  }
  if (is_open) read_available(output_, output);
  if (errors_ >= 0) read_available(errors_, output);
  if (!process_) return end;
  rusage usage{};
  const int status = process_->end(&usage);
  end.cpu_seconds = std::max(cost.cpu_seconds, seconds(usage.ru_utime) + seconds(usage.ru_stime));
  end.peak_memory = std::max(cost.peak_memory, std::int64_t{1024} * usage.ru_maxrss);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  // Bubblewrap exits with 128 + the signal that ended the program.
  constexpr int kSignaled = 128;
  if (is_sandboxed_ && end.exit_code > kSignaled && end.exit_code < kSignaled + NSIG) {
    end.signal = std::exchange(end.exit_code, -1) - kSignaled;
  }
  return end;
}

bool read_available(int file, std::string& text) {
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got < 0 && errno == EAGAIN;
    text.append(buffer.data(), static_cast<std::size_t>(got));
    if (text.size() > kKeptOutput) text.erase(0, text.size() - kKeptOutput);
  }
}

std::string text(const ProgramEnd& end) {
  if (end.start_error != 0) {
    return std::string("cannot be started: ") + std::strerror(end.start_error);
  }
  if (end.signal == 0) return "exited with code " + std::to_string(end.exit_code);
  return "was ended by " + signal_name(end.signal);
}

}  // namespace loopbench::harness
