#include "harness/catalogue/own_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>

#include "datasets/core/error.hpp"
#include "datasets/core/pack.hpp"
#include "datasets/core/params.hpp"

namespace loopbench::harness {
namespace {

using Clock = std::chrono::steady_clock;

enum class Kind { returned, option_error, input_error, missing_part, out_of_memory, other_error };

struct Answer {
  Kind kind = Kind::returned;
  std::string option;
  std::string text;
};

template <class Archive, Either<Answer> T>
void walk(Archive& a, T& answer) {
  a(answer.kind)(answer.option)(answer.text);
}

Answer answer_of(const std::function<std::string()>& work) {
  try {
    return {Kind::returned, "", work()};
  } catch (const OptionError& error) {
    return {Kind::option_error, error.option(), error.what()};
  } catch (const InputError& error) {
    return {Kind::input_error, "", error.what()};
  } catch (const MissingPart& error) {
    return {Kind::missing_part, "", error.what()};
  } catch (const std::bad_alloc&) {
    return {Kind::out_of_memory, "", ""};
  } catch (const std::exception& error) {
    return {Kind::other_error, "", error.what()};
  } catch (...) {
    return {Kind::other_error, "", "threw something that is not a std::exception"};
  }
}

/// Data memory of this process [bytes].
rlim_t data_bytes() {
  std::ifstream in("/proc/self/statm");
  rlim_t total = 0, skipped = 0, data = 0;
  in >> total >> skipped >> skipped >> skipped >> skipped >> data;
  return data * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void answer_and_exit(const std::function<std::string()>& work,
                                  const ProcessLimits& limits,
                                  int answers) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  if (limits.memory > 0) {
    const rlim_t most = data_bytes() + static_cast<rlim_t>(limits.memory);
    const rlimit both{most, most};
    setrlimit(RLIMIT_DATA, &both);
  }
  Packer pack;
  pack(answer_of(work));
  const std::uint64_t size = pack.bytes().size();
  std::string message(reinterpret_cast<const char*>(&size), sizeof size);
  message += pack.bytes();
  for (std::size_t at = 0; at < message.size();) {
    const ssize_t written = write(answers, message.data() + at, message.size() - at);
    if (written <= 0 && errno != EINTR) break;
    at += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
  std::fflush(stdout);
  _exit(0);  // without running destructors of this program
}

/// The bytes of an answer; shorter if the process ended before. False after the deadline.
bool receive(int answers, const ProcessLimits& limits, std::string& out) {
  const auto begin = Clock::now();
  std::array<char, 1 << 16> buffer;
  std::uint64_t size = 0;
  while (out.size() < sizeof size || out.size() < sizeof size + size) {
    const std::chrono::duration<double> passed = Clock::now() - begin;
    const double left = limits.seconds > 0.0 ? limits.seconds - passed.count() : 1.0;
    if (left <= 0.0) return false;
    pollfd event{answers, POLLIN, 0};
    if (poll(&event, 1, static_cast<int>(1e3 * left) + 1) <= 0) continue;
    const ssize_t got = read(answers, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    out.append(buffer.data(), static_cast<std::size_t>(got));
    if (out.size() >= sizeof size) std::memcpy(&size, out.data(), sizeof size);
  }
  return true;
}

std::string end_text(int status) {
  if (WIFEXITED(status)) return fmt::format("exited with code {}", WEXITSTATUS(status));
  const char* name = sigabbrev_np(WTERMSIG(status));
  return "was ended by SIG" + std::string(name == nullptr ? "NAL" : name);
}

}  // namespace

std::string in_own_process(const std::function<std::string()>& work, const ProcessLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
  std::fflush(nullptr);  // otherwise the process would print buffered output again
  const pid_t process = fork();
  if (process == 0) answer_and_exit(work, limits, ends[1]);
  close(ends[1]);
  std::string bytes;
  const bool is_in_time = process > 0 && receive(ends[0], limits, bytes);
  close(ends[0]);
  if (process < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  Answer answer;
  bool has_answered = true;
  try {
    Unpacker unpack(std::string_view(bytes).substr(std::min(bytes.size(), sizeof(std::uint64_t))));
    unpack(answer);
  } catch (const std::runtime_error&) {
    has_answered = false;
  }
  int status = 0;
  // Without an answer it has ended, or is to be ended now.
  if (has_answered || !is_in_time) kill(process, SIGKILL);
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  kill(-process, SIGKILL);  // what it started
  if (!is_in_time) throw ProcessFailure(fmt::format("took longer than {} s", limits.seconds));
  if (!has_answered) throw ProcessFailure(end_text(status));
  switch (answer.kind) {
    case Kind::returned:
      return answer.text;
    case Kind::option_error:
      throw OptionError(answer.option, answer.text);
    case Kind::input_error:
      throw InputError(answer.text);
    case Kind::missing_part:
      throw MissingPart(answer.text);
    case Kind::out_of_memory:
      throw ProcessFailure(
          limits.memory > 0
              ? fmt::format("needs more memory than the limit of {} bytes", limits.memory)
              : "needs more memory than there is");
    case Kind::other_error:
      break;
  }
  throw std::runtime_error(answer.text);
}

}  // namespace loopbench::harness
