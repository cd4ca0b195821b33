#include "harness/sweep/catalogue/program_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kOpen = "open.txt";
constexpr const char* kRecord = "record";  // hashes of the output as it was written, and the cost
constexpr const char* kSuffixes[] = {"", ".frames", ".loops", ".closed"};

/// Locks a file, which is created if it is absent and stays, until destroyed or until the process
/// ends. Waits for other holders.
class FileLock {
 public:
  /// Throws InputError if the file cannot be opened for writing.
  explicit FileLock(const std::filesystem::path& file)
      : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)) {
    if (descriptor_ < 0) {
      throw InputError(file.string() + ": cannot be written: " + std::strerror(errno));
    }
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~FileLock() { close(descriptor_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

/// "NAME HASH" lines of the program's output in a folder.
std::string output_hashes(const std::filesystem::path& folder) {
  std::string out;
  for (const char* suffix : kSuffixes) {
    const std::filesystem::path file = folder / (std::string(kOpen) + suffix);
    if (std::filesystem::is_regular_file(file)) {
      out += file.filename().string() + " " + hex(hash_of_file(file)) + "\n";
    }
  }
  return out;
}

/// What is in a folder, if it is what the program wrote.
std::optional<ProgramOutput> intact_output(const std::filesystem::path& folder) {
  std::ifstream in(folder / kRecord, std::ios::binary);
  ProgramOutput out{folder / kOpen, {}};
  std::string rest;
  if (!(in >> out.cost.seconds >> out.cost.peak_memory) || !std::getline(in, rest)) return {};
  const std::string hashes{std::istreambuf_iterator<char>(in), {}};
  if (hashes.empty() || hashes != output_hashes(folder)) return {};
  return out;
}

}  // namespace

bool is_own_file(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, none));
}

ProgramOutput kept_output(
    const std::filesystem::path& all,
    const std::string& key,
    const std::function<ProgramCost(const std::filesystem::path& trajectory)>& run) {
  const std::filesystem::path folder = all / key;
  if (const auto found = intact_output(folder)) return *found;
  std::filesystem::create_directories(all);
  const FileLock lock(all / (key + ".lock"));
  if (const auto found = intact_output(folder)) return *found;
  const ExchangeFolder work;
  const ProgramCost cost = run(work.path() / kOpen);
  std::string part = (all / (key + "-XXXXXX")).string();
  if (mkdtemp(part.data()) == nullptr) throw InputError(part + ": cannot be created");
  try {
    for (const char* suffix : kSuffixes) {
      const std::string name = std::string(kOpen) + suffix;
      if (is_own_file(work.path() / name)) {
        std::filesystem::copy_file(work.path() / name, std::filesystem::path(part) / name);
      }
    }
    write_file(std::filesystem::path(part) / kRecord,
               fmt::format("{} {}\n{}", cost.seconds, cost.peak_memory, output_hashes(part)));
    std::filesystem::remove_all(folder);  // an incomplete or changed one
    std::filesystem::rename(part, folder);
  } catch (...) {
    std::filesystem::remove_all(part);
    throw;
  }
  return {folder / kOpen, cost};
}

}  // namespace loopbench::harness
