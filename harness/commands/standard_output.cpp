#include "harness/commands/standard_output.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "harness/base/wrap.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kUsualWidth = 80;
constexpr std::size_t kNarrowest = 40;

std::string_view environment(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

}  // namespace

bool prints_to_terminal() { return isatty(STDOUT_FILENO) == 1; }

TerminalStyle standard_output_style() {
  if (!prints_to_terminal()) return {};
  TerminalStyle out;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) out.width = size.ws_col;
  if (out.width == 0) {
    const std::string columns(environment("COLUMNS"));
    out.width = std::strtoul(columns.c_str(), nullptr, 10);
  }
  if (out.width == 0) out.width = kUsualWidth;
  out.width = std::max(out.width, kNarrowest);
  out.color = environment("NO_COLOR").empty() && environment("TERM") != "dumb";
  return out;
}

std::string fitted(const std::string& line) {
  const std::size_t columns = standard_output_style().width;
  std::string out;
  for (const std::string& part : wrapped(line, columns == 0 ? 0 : columns - 2)) {
    out += (out.empty() ? "" : "\n  ") + part;
  }
  return out;
}

std::string program_name() {
  const std::string_view given = environment("LOOPBENCH_NAME");
  return given.empty() ? "loopbench" : std::string(given);
}

}  // namespace loopbench::harness
