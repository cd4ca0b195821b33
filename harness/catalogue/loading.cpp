#include "harness/catalogue/loading.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"

namespace loopbench::harness {
namespace {

std::filesystem::path cache_folder() {
  if (const char* own = std::getenv("LOOPBENCH_CACHE")) return own;
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return std::filesystem::path(cache) / "loopbench";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".cache" / "loopbench";
}

void draw(const std::string& stage, std::size_t done, std::size_t total) {
  const std::size_t step = std::max<std::size_t>(1, total / 100);
  if (done % step != 0 && done != total) return;
  print_error("\r\033[K{}", loading_line(stage, done, total));
  if (done == total) print_error("\r\033[K");
  std::fflush(stderr);
}

}  // namespace

rgbd::FrontendHooks loading_hooks() {
  rgbd::FrontendHooks out;
  if (isatty(STDERR_FILENO) == 1) out.progress = draw;
  out.cache = cache_folder();
  out.build = front_end_hash;
  return out;
}

std::string loading_line(const std::string& stage, std::size_t done, std::size_t total) {
  constexpr std::size_t kBar = 20;  // [columns]
  const std::size_t filled = total == 0 ? kBar : kBar * done / total;
  return fmt::format(
      "[{:#<{}}{:.<{}}] {}/{}  {}", "", filled, "", kBar - filled, done, total, stage);
}

void print_notes(const std::string& label, const std::vector<std::string>& notes) {
  std::string out;
  for (const std::string& note : notes) {
    out += fmt::format("{}: {}\n", printable(label), printable(note));
  }
  print_error("{}", out);
}

}  // namespace loopbench::harness
