#include "harness/export/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "datasets/core/error.hpp"

namespace loopbench {

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path part = file;
  part += ".part";
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  errno = 0;
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    const int reason = errno;
    std::filesystem::remove(part, error);
    throw InputError(file.string() + ": cannot be written" +
                     (reason == 0 ? "" : std::string(": ") + std::strerror(reason)));
  }
  std::filesystem::rename(part, file, error);
  if (error) throw InputError(file.string() + ": cannot be written: " + error.message());
}

}  // namespace loopbench
