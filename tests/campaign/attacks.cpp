#include "tests/campaign/attacks.hpp"

#include <signal.h>

#include <algorithm>
#include <fstream>
#include <thread>

namespace loopbench::campaign {
namespace {

constexpr int kKilled = 128 + SIGKILL;
constexpr int kInterrupted = 130;
constexpr int kBadInput = 2;

/// Random options of `run` that recompute cells which are there.
std::vector<std::string> random_options(History& history) {
  switch (history.random() % 8) {
    case 0:
      return {"--retry", "all"};
    case 2:
      return {"--retry", "failed"};
    default:
      return {};
  }
}

/// Starts a sweep, calls `disturb` after a random time, and checks that no cell is lost.
void disturbed(History& history,
               const std::set<int>& codes,
               const std::function<void(Child& child)>& disturb) {
  const std::set<std::string> before = history.cells(history.store());
  std::vector<std::string> options = random_options(history);
  const bool recomputes = !options.empty() && options.back() == "all";
  Child child(history.run_words(options), history.path("output"));
  history.sleep_some();
  disturb(child);
  std::set<int> allowed = codes;
  allowed.insert(history.undisturbed().exit_code);
  const int code = history.ended(child, allowed);
  if (code != history.undisturbed().exit_code) ++history.counts["hits"];
  if (!recomputes) history.expect_kept(history.store(), before);
}

void kill_sweep(History& history) {
  disturbed(history, {kKilled}, [&](Child& child) {
    history.one_in(2) ? child.signal(SIGKILL) : child.signal_group(SIGKILL);
  });
  ++history.counts["kills"];
}

void terminate_sweep(History& history) {
  disturbed(history, {kInterrupted, 128 + SIGTERM, 128 + SIGHUP}, [&](Child& child) {
    const int number = history.one_in(4) ? SIGHUP : SIGTERM;
    history.one_in(2) ? child.signal(number) : child.signal_group(number);
  });
}

void interrupt_sweep(History& history) {
  disturbed(history, {kInterrupted, 128 + SIGINT}, [&](Child& child) {
    child.signal_group(SIGINT);
    if (!history.one_in(2)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(history.random() % 20));
    child.signal_group(SIGINT);
  });
}

/// Ctrl-Z and `fg`.
void stop_sweep(History& history) {
  disturbed(history, {}, [&](Child& child) {
    const unsigned times = 1 + static_cast<unsigned>(history.random() % 3);
    for (unsigned i = 0; i < times; ++i) {
      child.signal_group(history.one_in(4) ? SIGSTOP : SIGTSTP);
      std::this_thread::sleep_for(std::chrono::milliseconds(history.random() % 100));
      child.signal_group(SIGCONT);
      std::this_thread::sleep_for(std::chrono::milliseconds(history.random() % 20));
    }
  });
}

void resume_sweep(History& history) {
  history.command(history.run_words({"--retry", "failed"}), {history.undisturbed().exit_code});
  history.expect_kept(history.store(), history.undisturbed().cells);
}

/// A worker is killed: its cell is recorded as crashed and computed again by the end of the
/// history.
void kill_worker(History& history) {
  disturbed(history, {1}, [&](Child& child) {
    const std::vector<pid_t> workers = children_of(child.id());
    if (workers.empty()) return;
    ++history.counts["workers killed"];
    ::kill(workers[history.random() % workers.size()], SIGKILL);
  });
  resume_sweep(history);
}

std::filesystem::path newest_previous(const std::filesystem::path& folder) {
  std::filesystem::path newest;
  for (int number = 1;; ++number) {
    const std::filesystem::path file = folder / ("previous-" + std::to_string(number) + ".sqlite");
    if (!std::filesystem::exists(file)) return newest;
    newest = file;
  }
}

/// The old store is kept completely, however the new sweep ends.
void start_fresh(History& history) {
  const std::set<std::string> before = history.cells(history.store());
  const std::filesystem::path last = newest_previous(history.out());
  Child child(history.run_words({"--fresh"}), history.path("output"));
  const bool is_killed = history.one_in(2);
  if (is_killed) {
    history.sleep_some();
    child.signal_group(SIGKILL);
    ++history.counts["kills"];
  }
  history.ended(child, {history.undisturbed().exit_code, kKilled});
  const std::filesystem::path previous = newest_previous(history.out());
  history.expect_kept(previous != last ? previous : history.store(), before);
  // Keeps the folder small; the names in use are still consecutive.
  if (previous.filename() == "previous-5.sqlite") {
    for (const auto& file : std::filesystem::directory_iterator(history.out())) {
      if (file.path().filename().string().starts_with("previous-")) {
        std::filesystem::remove(file.path());
      }
    }
  }
}

/// The disk takes only some bytes per file.
void fill_disk(History& history) {
  const std::set<std::string> before = history.cells(history.store());
  const std::uint64_t limit = 4096 * (1 + history.random() % 120);
  const std::vector<std::string> options = random_options(history);
  const bool recomputes = !options.empty() && options.back() == "all";
  const int code = history.command(
      history.run_words(options), {history.undisturbed().exit_code, kBadInput, 1}, limit);
  if (code == kBadInput) ++history.counts["full disks"];
  if (code == kBadInput && history.output().find(history.out().string()) == std::string::npos) {
    throw Broken("a full disk without the name of the file: " + history.output());
  }
  if (!recomputes) history.expect_kept(history.store(), before);
}

/// Two stores with different cells, either of which can be killed, become one.
void merge_parts(History& history) {
  std::vector<std::filesystem::path> parts;
  for (const char* pattern : {"^a", "^[^a]"}) {
    parts.push_back(history.path("part" + std::to_string(parts.size())));
    const std::vector<std::string> only{"--only", pattern};
    Child child(history.run_words(only, parts.back()), history.path("output"));
    if (history.one_in(2)) {
      history.sleep_some();
      child.signal_group(SIGKILL);
      ++history.counts["kills"];
    }
    const int code = history.ended(child, {0, 1, kKilled, kBadInput});
    if (code == kBadInput) return;  // the config has no such cells
    if (history.cells(parts.back() / "results.sqlite").empty()) {
      history.command(history.run_words(only, parts.back()), {0, 1});
    }
  }
  std::set<std::string> both;
  for (const std::filesystem::path& part : parts)
    both.merge(history.cells(part / "results.sqlite"));
  const std::filesystem::path merged = history.path("merged");
  history.command({history.settings().binary, "merge", parts[0], parts[1], "-o", merged}, {0});
  history.expect_kept(merged / "results.sqlite", both);
  std::filesystem::remove_all(history.out());
  std::filesystem::rename(merged, history.out());
  for (const std::filesystem::path& part : parts) std::filesystem::remove_all(part);
}

/// Changes bytes, pages or the length of a file.
void damage_file(History& history, const std::filesystem::path& file) {
  std::error_code none;
  const std::uint64_t size = std::filesystem::file_size(file, none);
  if (none || size == 0) return;
  if (history.one_in(4)) {
    std::filesystem::resize_file(file, history.random() % size);
    return;
  }
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  const bool is_page = history.one_in(2);
  const std::uint64_t places = is_page ? 1 + history.random() % 3 : 1 + history.random() % 30;
  for (std::uint64_t i = 0; i < places; ++i) {
    const std::uint64_t at =
        is_page ? history.random() % size / 4096 * 4096 : history.random() % size;
    stream.seekp(static_cast<std::streamoff>(at));
    for (int k = 0; k < (is_page ? 4096 : 1); ++k) {
      stream.put(static_cast<char>(history.one_in(2) ? 0 : history.random()));
    }
  }
}

/// A sweep, killed or not, whose files are damaged: `run` repairs it, or rejects it, and --fresh
/// starts again.
void damage_store(History& history) {
  if (history.one_in(2)) kill_sweep(history);
  if (!std::filesystem::exists(history.store())) return;
  const std::filesystem::path log = history.store().string() + "-wal";
  damage_file(history, std::filesystem::exists(log) && history.one_in(2) ? log : history.store());
  ++history.counts["damages"];
  // Readers print rows of an intact store or one error.
  history.command({history.settings().binary, "table", history.out()}, {0, kBadInput});
  const int done = history.undisturbed().exit_code;
  if (history.command(history.run_words(), {done, kBadInput}) == done) return;
  ++history.counts["not repaired"];
  history.command(history.run_words({"--fresh"}), {done});
}

/// Of two sweeps in one folder, at least one runs; the other is rejected.
void run_twice(History& history) {
  const std::set<std::string> before = history.cells(history.store());
  Child first(history.run_words(), history.path("output"));
  Child second(history.run_words(), history.path("output"));
  const int done = history.undisturbed().exit_code;
  const int one = first.wait(history.settings().limit);
  const int other = history.ended(second, {done, kBadInput});
  if (one != done && (one != kBadInput || other != done)) {
    throw Broken("two sweeps in one folder: exit codes " + std::to_string(one) + " and " +
                 std::to_string(other));
  }
  history.expect_kept(history.store(), before);
}

}  // namespace

std::vector<Attack> attacks() {
  return {{"kill", 8, kill_sweep},
          {"terminate", 2, terminate_sweep},
          {"Ctrl-C", 2, interrupt_sweep},
          {"Ctrl-Z", 2, stop_sweep},
          {"kill a worker", 1, kill_worker},
          {"--fresh", 2, start_fresh},
          {"resume", 1, resume_sweep},
          {"merge", 1, merge_parts},
          {"full disk", 1, fill_disk},
          {"damage and repair", 3, damage_store},
          {"two sweeps", 1, run_twice}};
}

}  // namespace loopbench::campaign
