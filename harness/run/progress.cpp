#include "harness/run/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace loopbench {
namespace {

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::size_t total) : visible_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

bool Progress::due(bool last) {
  const auto now = Clock::now();
  if (!visible_ || (!last && now - drawn_ < std::chrono::milliseconds(100))) return false;
  drawn_ = now;
  return true;
}

void Progress::draw(const std::string& line) {
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
}

void Progress::step(const std::string& label) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (!due(done_ == total_)) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  // One column short: writing the last one makes some terminals wrap.
  draw(progress_line(done_, total_, seconds, label, terminal_width() - 1));
}

void Progress::loading(const std::string& stage, std::size_t done, std::size_t total) {
  const std::lock_guard lock(mutex_);
  if (due(done == total)) draw(loading_line(done, total, stage, terminal_width() - 1));
}

void Progress::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "{}{}\n", visible_ ? "\r\033[K" : "", text);
}

namespace {

constexpr std::size_t kBar = 20;  // [columns]

std::string bar(std::size_t done, std::size_t total) {
  const std::size_t filled = total == 0 ? kBar : kBar * done / total;
  return fmt::format("[{:#<{}}{:.<{}}] {}/{}", "", filled, "", kBar - filled, done, total);
}

}  // namespace

std::string loading_line(std::size_t done,
                         std::size_t total,
                         const std::string& stage,
                         std::size_t width) {
  return fmt::format("{}  {}", bar(done, total), stage).substr(0, width);
}

std::string progress_line(std::size_t done,
                          std::size_t total,
                          double seconds,
                          const std::string& label,
                          std::size_t width) {
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const std::string line =
      fmt::format("{}  {:.1f} cells/s  {:.0f} s left  {}", bar(done, total), rate, left, label);
  return line.substr(0, width);
}

}  // namespace loopbench
