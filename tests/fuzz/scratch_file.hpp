/// Files of fuzz targets whose reader needs a name or a folder.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace loopbench {

inline std::string fuzz_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// An empty folder of this process, in memory where possible; the same one at every call.
inline std::filesystem::path fuzz_folder() {
  const std::filesystem::path memory = "/dev/shm";
  const std::filesystem::path out =
      (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
      ("loopbench-fuzz-" + std::to_string(getpid()));
  std::filesystem::remove_all(out);
  std::filesystem::create_directories(out);
  return out;
}

/// Writes the input of a target to `folder` / `name`.
inline std::filesystem::path fuzz_file(const std::filesystem::path& folder,
                                       const std::string& name,
                                       const std::string& bytes) {
  std::ofstream(folder / name, std::ios::binary) << bytes;
  return folder / name;
}

}  // namespace loopbench
