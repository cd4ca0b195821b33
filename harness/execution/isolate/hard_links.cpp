#include "harness/execution/isolate/hard_links.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <system_error>

namespace loopbench::harness {
namespace {

std::uintmax_t number_of_names(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return 1;
  const std::uintmax_t count = std::filesystem::hard_link_count(file, error);
  return error ? 1 : count;
}

/// Empty if every file has one name.
std::string note_about_links(const std::vector<InputFile>& inputs) {
  std::string out;
  std::size_t others = 0;
  for (const InputFile& input : inputs) {
    const std::uintmax_t count = number_of_names(input.path);
    if (count < 2) continue;
    if (!out.empty()) ++others;
    if (out.empty()) out = fmt::format("{} has {} names (hard links)", input.path, count);
  }
  if (others > 0) out += fmt::format(", as have {} more files", others);
  if (!out.empty()) out += "; methods cannot read it under this name, but can under the others";
  return out;
}

}  // namespace

std::vector<std::string> printed_notes(const SequenceMetadata& metadata, bool is_sandboxed) {
  std::vector<std::string> out = metadata.notes;
  const std::string links = is_sandboxed ? note_about_links(metadata.inputs) : "";
  if (!links.empty()) out.push_back(links);
  return out;
}

}  // namespace loopbench::harness
