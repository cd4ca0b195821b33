#include "harness/store/rename_file.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace loopbench::harness {

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::rename(from, to);
  const std::filesystem::path folder = to.has_parent_path() ? to.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the file is complete under its new name
  fsync(descriptor);
  close(descriptor);
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
