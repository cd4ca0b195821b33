// A folder with one file per frame, each a 4 x 4 matrix: ScanNet (0.txt), 7-Scenes
// (frame-000000.pose.txt).
#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/matrix_lines.hpp"
#include "datasets/formats/matrix_list.hpp"

namespace loopbench {
namespace {

/// The number in a name such as 12.txt or frame-000012.pose.txt; nothing for other files.
std::optional<std::size_t> frame_number(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  if (file.extension() != ".txt") return std::nullopt;
  name.resize(name.find('.'));
  const std::size_t first = name.find_last_not_of("0123456789") + 1;
  const std::string prefix = name.substr(0, first);
  if (prefix != "" && prefix != "frame-" && prefix != "frame_" && prefix != "frame") {
    return std::nullopt;
  }
  std::size_t out = 0;
  const auto [stop, error] = std::from_chars(name.data() + first, name.data() + name.size(), out);
  return error == std::errc{} && first < name.size() ? std::optional(out) : std::nullopt;
}

using NumberedFiles = std::vector<std::pair<std::size_t, std::filesystem::path>>;

/// Files of frames in the order of their numbers.
NumberedFiles frame_files(const std::filesystem::path& folder) {
  NumberedFiles out;
  std::error_code error;  // also of a folder that cannot be read
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const auto number = frame_number(entry.path());
    if (number && entry.is_regular_file(error)) out.emplace_back(*number, entry.path());
  }
  std::ranges::sort(out);
  return out;
}

/// Whether the first line has the four numbers of a matrix: trajectories can be named 0.txt, too.
bool begins_with_matrix(const std::filesystem::path& file) {
  try {
    TextFile text(file);
    std::istringstream words{std::string(first_line(text).text)};
    return std::distance(std::istream_iterator<std::string>(words), {}) == 4;
  } catch (const InputError&) {
    return false;
  }
}

bool is_folder_of_frames(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_directory(file, error)) return false;
  const NumberedFiles files = frame_files(file);
  return !files.empty() && begins_with_matrix(files.front().second);
}

TrajectoryFile read_frames(const std::filesystem::path& folder, const ReadOptions& options) {
  std::vector<ListedMatrix> matrices;
  for (const auto& [number, path] : frame_files(folder)) {
    TextFile file(path);
    const Line line = first_line(file);
    Line first;
    file.next(first);
    matrices.push_back({path.filename().string() + ":" + std::to_string(line.number),
                        read_matrix_lines(file, first),
                        static_cast<double>(number)});
  }
  ReadFindings findings;
  findings.clock = Clock::ids;
  TrajectoryFile out = poses_of_matrices(folder.string(), matrices, options, std::move(findings));
  out.format = Format::frames;
  return out;
}

}  // namespace

FormatEntry frames_format() {
  return {.format = Format::frames, .guess_file = is_folder_of_frames, .read_file = read_frames};
}

}  // namespace loopbench
