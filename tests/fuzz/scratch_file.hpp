/// Helpers of fuzz targets: checks, and files of readers that need a name or a folder.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "datasets/core/error.hpp"

namespace loopbench {

inline void check_holds(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("violated postcondition: ") + what);
}

/// Calls `act`; InputError is expected, other exceptions are findings.
template <class Act>
void unless_rejected(Act act) {
  try {
    act();
  } catch (const InputError&) {
    // rejected with a message, as expected
  }
}

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
