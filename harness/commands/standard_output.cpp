#include "harness/commands/standard_output.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kDefaultWidth = 80;
constexpr std::size_t kNarrowest = 40;

std::string_view environment(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

/// `line` broken at spaces into `columns`, later lines indented; 0: one line.
std::string indented(const std::string& line, std::size_t columns) {
  std::string out;
  for (const std::string& part : wrapped(line, columns == 0 ? 0 : columns - 2)) {
    out += (out.empty() ? "" : "\n  ") + part;
  }
  return out;
}

}  // namespace

std::size_t terminal_width(int stream) {
  std::size_t out = 0;
  winsize size{};
  if (ioctl(stream, TIOCGWINSZ, &size) == 0) out = size.ws_col;
  if (out == 0) {
    const std::string columns(environment("COLUMNS"));
    out = std::strtoul(columns.c_str(), nullptr, 10);
  }
  return std::max(out == 0 ? kDefaultWidth : out, kNarrowest);
}

bool prints_to_terminal() { return isatty(STDOUT_FILENO) == 1; }

TerminalStyle standard_output_style() {
  if (!prints_to_terminal()) return {};
  TerminalStyle out;
  out.width = terminal_width(STDOUT_FILENO);
  out.color = environment("NO_COLOR").empty() && environment("TERM") != "dumb";
  return out;
}

std::string fitted(const std::string& line) {
  return indented(line, standard_output_style().width);
}

std::string fitted_error(const std::string& line) {
  return indented(line, isatty(STDERR_FILENO) == 1 ? terminal_width(STDERR_FILENO) : 0);
}

std::string fitted_lines(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_row = line.find("   ") != std::string::npos;  // broken, its columns are lost
    out += (is_row ? line : fitted(line)) + "\n";
  }
  return out;
}

std::string program_name() {
  const std::string_view given = environment("LOOPBENCH_NAME");
  return given.empty() ? "loopbench" : std::string(given);
}

}  // namespace loopbench::harness
