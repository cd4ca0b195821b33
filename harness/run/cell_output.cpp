#include "harness/run/cell_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace loopbench::harness {

void make_printable(std::span<char> text, char& previous) {
  for (char& each : text) {
    const auto byte = static_cast<unsigned char>(each);
    const bool is_space = each == '\n' || each == '\t' || each == '\r';
    const bool is_c1 = previous == '\xc2' && byte >= 0x80 && byte <= 0x9f;
    previous = each;
    if ((byte < 0x20 && !is_space) || byte == 0x7f || is_c1) each = '?';
  }
}

CellOutput::CellOutput() {
  if (pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
  fcntl(ends_[0], F_SETFL, O_NONBLOCK);
}

CellOutput::~CellOutput() {
  close_read_end();
  close_write_end();
}

void CellOutput::close_read_end() {
  if (ends_[0] >= 0) close(ends_[0]);
  ends_[0] = -1;
}

void CellOutput::close_write_end() {
  if (ends_[1] >= 0) close(ends_[1]);
  ends_[1] = -1;
}

bool CellOutput::forward() {
  char buffer[1 << 14];
  while (total_ <= kMost && ends_[0] >= 0) {
    const ssize_t size = read(ends_[0], buffer, sizeof buffer);
    if (size < 0) break;  // nothing now
    if (size == 0) close_read_end();
    const std::int64_t shown = std::clamp<std::int64_t>(kForwarded - total_, 0, size);
    if (shown > 0) {
      make_printable({buffer, static_cast<std::size_t>(shown)}, last_);
      [[maybe_unused]] const ssize_t written =
          write(STDERR_FILENO, buffer, static_cast<std::size_t>(shown));
    }
    total_ += size;
  }
  return total_ <= kMost;
}

}  // namespace loopbench::harness
