// Trajectories as .log of Redwood and Open3D: a line with numbers of frames, then a 4 x 4 matrix.
#include <array>
#include <charconv>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_matrix.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/known_layouts.hpp"
#include "datasets/formats/matrix_lines.hpp"

namespace loopbench {
namespace {

/// The number in a column; also nan and inf.
double any_number(const TextFile& file, const Line& line, std::string_view word) {
  double out = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  if (error == std::errc{} && stop == word.data() + word.size()) return out;
  throw file.error(line.number, "'" + std::string(word.substr(0, 40)) + "' is not a number");
}

}  // namespace

PoseMatrix read_matrix_lines(TextFile& file, const Line& first) {
  PoseMatrix out;
  Line line = first;
  for (Eigen::Index row = 0; row < 4; ++row) {
    if (row > 0 && !file.next(line)) {
      if (row == 3) return out;
      throw file.error(first.number,
                       "has a matrix of " + std::to_string(row) + " lines, expected 4");
    }
    if (count_columns(file, line) != 4) {
      throw file.error(line.number,
                       "has " + columns_text(count_columns(file, line)) +
                           ", expected 4: a row of a 4 x 4 matrix");
    }
    Columns columns(file, line);
    for (Eigen::Index column = 0; column < 4; ++column) {
      const double value = any_number(file, line, columns.word());
      const bool is_expected = value == (column == 3 ? 1.0 : 0.0) || !std::isfinite(value);
      if (row < 3) {
        out.matrix()(row, column) = value;
      } else if (!is_expected) {
        throw file.error(line.number, "the last row of the matrix is not 0 0 0 1");
      }
    }
  }
  return out;
}

namespace {

Trajectory read_log(TextFile& file, const ReadOptions& options) {
  Trajectory out;
  ReadFindings& found = file.repaired;
  for (Line line; file.next(line); ++found.rows) {
    if (count_columns(file, line) != 4 && !file.next(line)) {
      throw file.error(line.number, "ends before a matrix");
    }
    const std::size_t number = line.number;
    PoseMatrix pose = read_matrix_lines(file, line);
    if (is_missing(pose)) {
      const InvalidRow invalid(file.error(number, "has no pose, expected a rotation"));
      if (!options.drop_invalid) throw with_remedy(invalid);
      ++found.invalid;
      found.dropped.push_back(found.rows);
      continue;
    }
    const std::string why = normalise_matrix(pose, found);
    if (!why.empty()) throw file.error(number, why);
    out.push_back({static_cast<double>(found.rows), pose_of(pose)});
  }
  found.clock = Clock::rows;
  return out;
}

bool is_log(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  return (count == 3 || count == 4) && has_matrix_lines(file);
}

}  // namespace

FormatEntry log_format() {
  return {
      .format = Format::log, .guess = is_log, .read = read_log, .takes_times = [](const TextFile&) {
        return true;
      }};
}

}  // namespace loopbench
