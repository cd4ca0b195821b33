#include "harness/sweep/catalogue/server.hpp"

#include <fmt/format.h>
#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>

#include "harness/sweep/catalogue/message.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/process/program.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {
namespace {

using ServerClock = std::chrono::steady_clock;

/// In memory shared with forked processes.
struct SharedTurn {
  std::atomic<std::uint64_t> requested = 0;
  std::atomic<std::uint64_t> answered = 0;
};

ProgramStart server_start(const CommandOptions& options, const std::filesystem::path& scratch) {
  ProgramStart out;
  out.arguments = command_words("serve", options.serve, options.shell);
  out.folder = options.folder;
  out.environment = {{"TMPDIR", scratch.string()}};
  out.sandbox = &program_sandbox();
  out.writable = scratch;
  out.network = options.network;
  out.serves = true;
  return out;
}

class Server {
 public:
  explicit Server(const CommandOptions& options) : tree_(server_start(options, scratch_.path())) {
    void* shared = mmap(
        nullptr, sizeof(SharedTurn), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) throw std::runtime_error("cannot start a program: shared memory");
    turn_ = new (shared) SharedTurn;
  }
  ~Server() { munmap(turn_, sizeof(SharedTurn)); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  bool is_in_step() const {
    return turn_->requested == turn_->answered && !tree_.has_ended() && !has_output();
  }

  void append_to(RunningServers& out) const {
    out.processes.push_back(tree_.process());
    for (const int descriptor :
         {tree_.input(), tree_.output(), tree_.errors(), tree_.descriptor()}) {
      out.descriptors.push_back(descriptor);
    }
  }

  ServedAnswer ask(const Request& request, std::size_t poses, std::string& errors) {
    const std::uint64_t number = ++turn_->requested;
    unsent_ = request(number);
    received_.clear();
    errors_ = &errors;
    if (number == 1) wait_for_start();
    const TreeCost before = tree_cost(tree_.process());
    const auto begin = ServerClock::now();
    MessageHeader header;
    receive(sizeof header);
    std::memcpy(&header, received_.data(), sizeof header);
    check_header(header, number, poses);
    receive(sizeof header + header.text + header.data);
    const std::chrono::duration<double> took = ServerClock::now() - begin;
    if (received_.size() > sizeof header + header.text + header.data || has_output()) {
      throw std::runtime_error("the program wrote more than one answer");
    }
    turn_->answered = number;  // from here on the streams are in step, whatever the answer says
    read_available(tree_.errors(), errors);
    TreeCost cost = tree_cost(tree_.process());
    cost.cpu_seconds -= before.cpu_seconds;
    return {received_.substr(sizeof header, header.text),
            received_.substr(sizeof header + header.text),
            took.count(),
            cost};
  }

 private:
  /// Whether bytes are there that belong to no answer.
  bool has_output() const {
    pollfd file{tree_.output(), POLLIN, 0};
    return poll(&file, 1, 0) > 0 && (file.revents & POLLIN) != 0;
  }

  /// Hands over the header of the first request, and waits until the program reads it: until then
  /// it was starting.
  void wait_for_start() {
    constexpr useconds_t kBetweenChecks = 200;  // [us]
    send_some(sizeof(MessageHeader));
    int unread = 0;
    while (ioctl(tree_.input(), SIOCOUTQ, &unread) == 0 && unread > 0 && !tree_.has_ended()) {
      read_available(tree_.errors(), *errors_);
      usleep(kBetweenChecks);
    }
  }

  /// Sends and receives until at least `size` bytes are here.
  void receive(std::size_t size) {
    while (received_.size() < size) {
      std::array<pollfd, 4> files{{{tree_.output(), POLLIN, 0},
                                   {tree_.errors(), POLLIN, 0},
                                   {unsent_.empty() ? -1 : tree_.input(), POLLOUT, 0},
                                   {tree_.descriptor(), POLLIN, 0}}};
      if (poll(files.data(), files.size(), -1) < 0) continue;
      if (files[2].revents != 0) send_some(unsent_.size());
      if (files[1].revents != 0) read_available(tree_.errors(), *errors_);
      if (files[0].revents != 0) {
        if (!receive_some()) throw_end();
      } else if (files[3].revents != 0 && !has_output()) {
        throw_end();  // what it has started can hold its output open
      }
    }
  }

  void send_some(std::size_t most) {
    const ssize_t sent = send(tree_.input(), unsent_.data(), most, MSG_NOSIGNAL);
    if (sent > 0) unsent_.erase(0, static_cast<std::size_t>(sent));
    if (sent < 0 && errno != EAGAIN && errno != EINTR) unsent_.clear();  // its end is read next
  }

  bool receive_some() {
    std::array<char, 1 << 16> buffer;
    const ssize_t got = read(tree_.output(), buffer.data(), buffer.size());
    if (got > 0) received_.append(buffer.data(), static_cast<std::size_t>(got));
    return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
  }

  [[noreturn]] void throw_end() {
    throw std::runtime_error("the program " + text(tree_.wait(*errors_)) + " before its answer");
  }

  const ServerFolder scratch_;  // removed after the program has ended
  RunningProgram tree_;
  SharedTurn* turn_ = nullptr;
  std::string unsent_;
  std::string received_;
  std::string* errors_ = nullptr;
};

struct KnownServer {
  std::string key;
  std::unique_ptr<Server> server;
};

std::vector<KnownServer>& known_servers() {
  static thread_local std::vector<KnownServer> servers;
  return servers;
}

KnownServer& known_server(const CommandOptions& options) {
  std::vector<KnownServer>& servers = known_servers();
  const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}",
                                      options.serve,
                                      options.shell,
                                      options.folder.string(),
                                      options.role,
                                      options.network);
  const auto found = std::ranges::find(servers, key, &KnownServer::key);
  return found == servers.end() ? servers.emplace_back(KnownServer{key, nullptr}) : *found;
}

Server& running_server(const CommandOptions& options) {
  KnownServer& known = known_server(options);
  if (known.server && !known.server->is_in_step()) known.server.reset();
  if (!known.server) known.server = std::make_unique<Server>(options);
  return *known.server;
}

}  // namespace

RunningServers running_servers() {
  RunningServers out;
  for (const KnownServer& known : known_servers()) {
    if (known.server) known.server->append_to(out);
  }
  return out;
}

void end_servers(bool only_stuck) {
  for (KnownServer& known : known_servers()) {
    if (known.server && !(only_stuck && known.server->is_in_step())) known.server.reset();
  }
}

void prepare_server(const CommandOptions& options) { running_server(options); }

ServedAnswer ask_served(const CommandOptions& options,
                        const Request& request,
                        std::size_t poses,
                        std::string& errors) {
  return running_server(options).ask(request, poses, errors);
}

namespace {

/// Poses of the program's answer, checked against the keyframes of `known`.
Trajectory ask_poses(const CommandOptions& options,
                     const Request& request,
                     const Problem& known,
                     methods::Report& report) {
  const auto begin = ServerClock::now();
  std::string errors;
  ResultMetadata metadata;
  ServedAnswer answer;
  Trajectory out;
  try {
    answer = ask_served(options, request, known.keyframes.size(), errors);
    out = checked_result(
        answer_poses(answer.text, answer.data, metadata), known, options.output, "the answer");
  } catch (const metrics::Undefined&) {
    throw;
  } catch (const std::runtime_error& error) {
    const std::string hidden = hidden_note(program_sandbox());
    throw std::runtime_error(with_output(error.what() + hidden, errors));
  }
  add_statements(report, metadata);
  report.notes.emplace_back("time: from request to answer");
  add_output(report, errors);
  add_costs(answer.cost.cpu_seconds, answer.cost.peak_memory);
  const std::chrono::duration<double> all = ServerClock::now() - begin;
  program_costs().exchange_seconds += all.count() - answer.seconds;
  return out;
}

class ServedUpdates final : public methods::Incremental {
 public:
  ServedUpdates(const CommandOptions& options, bool planar) : options_(options) {
    known_.planar = planar;
  }

  Trajectory update(const methods::Increment& added, methods::Report& report) override {
    known_.keyframes.insert(known_.keyframes.end(), added.keyframes.begin(), added.keyframes.end());
    const std::size_t update = updates_++;
    return ask_poses(
        options_,
        [&](std::uint64_t number) { return request(added, update, known_.planar, number); },
        known_,
        report);
  }

 private:
  CommandOptions options_;
  Problem known_;  ///< keyframes only
  std::size_t updates_ = 0;
};

}  // namespace

Trajectory ask_server(const CommandOptions& options,
                      const Problem& problem,
                      methods::Report& report) {
  return ask_poses(
      options,
      [&](std::uint64_t number) { return request(problem, options.output, number); },
      problem,
      report);
}

std::unique_ptr<methods::Incremental> served_updates(const CommandOptions& options, bool planar) {
  return std::make_unique<ServedUpdates>(options, planar);
}

}  // namespace loopbench::harness
