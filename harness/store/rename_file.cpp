#include "harness/store/rename_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace loopbench::harness {

namespace {

void sync_path(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_synced = descriptor >= 0 && fsync(descriptor) == 0;
  const std::error_code reason(errno, std::generic_category());
  if (descriptor >= 0) close(descriptor);
  if (!is_synced) throw std::filesystem::filesystem_error("cannot be synced", path, reason);
}

}  // namespace

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  sync_path(from);
  std::filesystem::rename(from, to);
  sync_path(to.has_parent_path() ? to.parent_path() : ".");
}

void remove_files_of(const std::filesystem::path& file) {
  std::error_code none;
  const std::string name = file.filename();
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (const auto& each : std::filesystem::directory_iterator(folder, none)) {
    if (each.path().filename().string().starts_with(name)) {
      std::filesystem::remove(each.path(), none);
    }
  }
}

}  // namespace loopbench::harness
