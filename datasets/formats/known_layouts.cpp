#include "datasets/formats/known_layouts.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "datasets/columns/columns.hpp"

namespace loopbench {

bool is_nanoseconds(std::string_view word) {
  constexpr std::size_t kMinDigits = 17;
  return word.size() >= kMinDigits &&
         std::all_of(word.begin(), word.end(), [](char c) { return '0' <= c && c <= '9'; });
}

double square_of_columns(const TextFile& file, const Line& line, std::size_t first, int count) {
  Columns columns(file, line);
  for (std::size_t i = 0; i < first; ++i) columns.word();
  double out = 0.0;
  for (int i = 0; i < count; ++i) {
    const std::string_view word = columns.word();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size()) return std::nan("");
    out += value * value;
  }
  return out;
}

bool is_unit_square(double square) { return std::abs(square - 1.0) <= 1e-3; }

bool is_of_colmap(const TextFile& file, const Line& line) {
  return count_columns(file, line) == 10 && is_unit_square(square_of_columns(file, line, 1, 4)) &&
         std::isnan(square_of_columns(file, line, 9, 1));
}

bool has_matrix_lines(const TextFile& file) {
  TextFile reopened = file.reopened();
  Line line;
  if (!reopened.next(line)) return false;
  if (count_columns(file, line) != 4 && !reopened.next(line)) return false;
  const bool begins =
      count_columns(file, line) == 4 && is_unit_square(square_of_columns(file, line, 0, 3));
  for (int i = 0; i < 3; ++i) reopened.next(line);
  return begins && count_columns(file, line) == 4 && square_of_columns(file, line, 0, 3) == 0.0;
}

void reject_known(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  const auto is_unit = [&](std::size_t first, int n) {
    return is_unit_square(square_of_columns(file, line, first, n));
  };
  std::string what;
  if (is_of_colmap(file, line)) {
    what =
        "has 10 columns as images.txt of COLMAP (camera_from_world): awk '!/^#/ && ++n%2 {print "
        "$1,$6,$7,$8,$3,$4,$5,$2}' " +
        file.name() +
        " > images.tum; loopbench traj transform images.tum "
        "--sort --invert-poses -o poses.txt; stamps are numbers of images, or take the time "
        "from the name in column 10";
  } else if (count == 7 && is_unit(3, 4)) {
    what =
        "has 7 columns, a pose x y z qx qy qz qw without a stamp? Expected one in the first "
        "column: paste -d' ' TIMES " +
        file.name() + " > poses.txt, with one time per line";
  } else if (count == 7 && file.name().find(".traj") != std::string::npos) {
    what =
        "has 7 columns in a .traj file as of ARKitScenes: a stamp, a rotation vector and a "
        "position "
        "of camera_from_world: awk '{a=sqrt($2^2+$3^2+$4^2); s=a?sin(a/2)/a:0.5; print "
        "$1,$5,$6,$7,$2*s,$3*s,$4*s,cos(a/2)}' OFMT=%.12g CONVFMT=%.17g " +
        file.name() +
        " > rows.txt; loopbench "
        "traj transform rows.txt --invert-poses -o poses.txt";
  } else if (count == 7) {
    what =
        "has 7 columns, a stamp, a position and three angles? Expected a quaternion; for the "
        "positions alone: awk '{print $1,$2,$3,$4}' " +
        file.name() + " > poses.txt";
  }
  if (what.empty()) return;
  throw file.error(line.number, what);
}

}  // namespace loopbench
