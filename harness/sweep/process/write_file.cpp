#include "harness/sweep/process/write_file.hpp"

#include <fmt/core.h>

#include <cstdio>

#include "datasets/core/error.hpp"
#include "datasets/files/replace_file.hpp"

namespace loopbench::harness {
namespace {

/// Failures are reported when the file is written.
void create_folder_of(const std::filesystem::path& file) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
}

}  // namespace

bool is_dash(const std::filesystem::path& file) { return file == "-"; }

void reject_standard_output(const std::string& option, const std::filesystem::path& file) {
  if (!is_dash(file)) return;
  throw InputError(option + " -: cannot be written to standard output, expected a name");
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  if (is_dash(file)) {
    fmt::print("{}", text);  // throws what fails, which main() reports
    return;
  }
  create_folder_of(file);
  replace_file(file, text, Target::named);
}

void write_result(const std::filesystem::path& file, const std::string& text) {
  create_folder_of(file);
  replace_file(file, text, Target::own);
}

}  // namespace loopbench::harness
