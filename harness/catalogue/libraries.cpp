#include "harness/catalogue/libraries.hpp"

#include <link.h>

#include <algorithm>
#include <iterator>
#include <system_error>

namespace loopbench::harness {
namespace {

using Files = std::vector<std::filesystem::path>;

int add_file(dl_phdr_info* object, std::size_t, void* files) {
  std::error_code none;  // the program itself and the kernel's object have no file names
  const std::filesystem::path file = std::filesystem::canonical(object->dlpi_name, none);
  if (!none) static_cast<Files*>(files)->push_back(file);
  return 0;
}

Files loaded_libraries() {
  Files out;
  dl_iterate_phdr(add_file, &out);
  std::ranges::sort(out);
  return out;
}

}  // namespace

const Files& program_libraries() {
  static const Files out = loaded_libraries();
  return out;
}

Files plugin_libraries(const std::filesystem::path& plugin) {
  Files out;
  std::ranges::set_difference(loaded_libraries(), program_libraries(), std::back_inserter(out));
  std::error_code none;
  std::erase(out, std::filesystem::canonical(plugin, none));
  return out;
}

}  // namespace loopbench::harness
