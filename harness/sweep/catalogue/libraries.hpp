/// Shared libraries of this process.
#pragma once

#include <link.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <vector>

namespace loopbench::harness {

using LibraryFiles = std::vector<std::filesystem::path>;

inline int add_file(dl_phdr_info* object, std::size_t, void* files) {
  std::error_code none;  // the program itself and the kernel's object have no file names
  const std::filesystem::path file = std::filesystem::canonical(object->dlpi_name, none);
  if (!none) static_cast<LibraryFiles*>(files)->push_back(file);
  return 0;
}

inline LibraryFiles loaded_libraries() {
  LibraryFiles out;
  dl_iterate_phdr(add_file, &out);
  std::ranges::sort(out);
  return out;
}

/// Files of the shared libraries that are loaded at the first call, sorted, with symbolic
/// links resolved (so that their names contain the versions). Call it before a plugin is loaded.
inline const LibraryFiles& program_libraries() {
  static const LibraryFiles out = loaded_libraries();
  return out;
}

/// Files of the libraries that were loaded since then, with the plugin, sorted.
inline LibraryFiles plugin_libraries(const std::filesystem::path& plugin) {
  LibraryFiles out;
  std::ranges::set_difference(loaded_libraries(), program_libraries(), std::back_inserter(out));
  std::error_code none;
  std::erase(out, std::filesystem::canonical(plugin, none));
  return out;
}

}  // namespace loopbench::harness
