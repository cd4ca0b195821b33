#include "datasets/rgbd/cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "datasets/hash.hpp"

namespace loopbench::rgbd {
namespace {

// Seed of the checksum; change it with the file layout.
constexpr std::uint64_t kChecksumSeed = 0x6c6f6f7062656e63u;
constexpr std::size_t kChecksumBytes = sizeof(std::uint64_t);

std::string checksum(const std::string& bytes) {
  const std::uint64_t sum = mixed(kChecksumSeed, bytes);
  std::string out(kChecksumBytes, '\0');
  std::memcpy(out.data(), &sum, kChecksumBytes);
  return out;
}

}  // namespace

std::optional<std::string> load_cached(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  std::string all((std::istreambuf_iterator<char>(in)), {});
  if (all.size() < kChecksumBytes) return std::nullopt;
  std::string bytes = all.substr(kChecksumBytes);
  if (all.compare(0, kChecksumBytes, checksum(bytes)) != 0) return std::nullopt;
  return bytes;
}

void store_cached(const std::filesystem::path& file, const std::string& bytes) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::filesystem::path temporary = fmt::format("{}.{}.tmp", file.string(), getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    out << checksum(bytes) << bytes;
    if (!out.flush()) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(temporary, file, error);
  if (error) std::filesystem::remove(temporary, error);
}

CacheLock::CacheLock(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  handle_ = open((file.string() + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (handle_ >= 0) flock(handle_, LOCK_EX);
}

CacheLock::~CacheLock() {
  if (handle_ >= 0) close(handle_);
}

std::filesystem::path cached_path(const std::filesystem::path& folder,
                                  const std::string& stage,
                                  std::uint64_t key) {
  return folder / fmt::format("{}-{:016x}", stage, key);
}

}  // namespace loopbench::rgbd
