#include "harness/run/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/catalogue/loading.hpp"

namespace loopbench::harness {
namespace {

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::size_t total) : visible_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() {
  if (visible_) print_error("\r\033[K");
}

void Progress::step(const std::string& label) {
  ++done_;
  const auto now = Clock::now();
  if (!visible_ || (done_ < total_ && now - drawn_ < std::chrono::milliseconds(100))) return;
  drawn_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  // One column short, because writing the last column wraps on some terminals.
  const std::string line = progress_line(done_, total_, seconds, label, terminal_width() - 1);
  print_error("\r\033[K{}", line);
  std::fflush(stderr);
}

std::string progress_line(std::size_t done,
                          std::size_t total,
                          double seconds,
                          const std::string& label,
                          std::size_t width) {
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const std::string text =
      fmt::format("{:.1f} cells/s  {:.0f} s left  {}", rate, left, printable(label));
  const std::string line = loading_line(text, done, total);
  return line.substr(0, width);
}

}  // namespace loopbench::harness
