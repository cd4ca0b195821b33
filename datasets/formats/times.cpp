#include "datasets/formats/times.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"

namespace loopbench {

void set_stamps(const std::string& file,
                const ReadOptions& options,
                ReadFindings& findings,
                Trajectory& poses) {
  if (!options.times) {
    for (StampedPose& pose : poses) pose.stamp *= options.period;
    return;
  }
  const std::vector<double> times = read_times(*options.times, options);
  const std::size_t rows = poses.size() + findings.invalid;
  const auto [first_pose, last_pose] = std::ranges::minmax_element(poses, {}, &StampedPose::stamp);
  if (first_pose->stamp < 0.0) {
    throw input_error(
        file, 0, fmt::format("has frame {}, expected frames from 0 on", first_pose->stamp));
  }
  const auto last = static_cast<std::size_t>(last_pose->stamp);
  const bool by_rows = findings.clock == Clock::rows;
  if (by_rows ? times.size() != rows : times.size() <= last) {
    const std::string found =
        by_rows ? fmt::format("{} poses", rows) : fmt::format("frame {}", last);
    throw input_error(file,
                      0,
                      fmt::format("has {}, but {} has {} times, expected {}",
                                  found,
                                  options.times->string(),
                                  times.size(),
                                  by_rows ? "equal numbers" : "one for each frame from 0 on"));
  }
  for (StampedPose& pose : poses) pose.stamp = times[static_cast<std::size_t>(pose.stamp)];
  findings.clock = Clock::stamps;
}

std::vector<double> read_times(const std::filesystem::path& path, const ReadOptions& options) {
  TextFile file(path);
  first_line(file);
  ReadOptions own{.sort = options.sort, .stamp_unit = options.stamp_unit};
  const int exponent = stamp_exponent(file, 0, own);
  std::vector<double> out;
  StampOrder order(file, own, exponent);
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    const std::string_view word = columns.peek();
    out.push_back(next_stamp(columns, exponent).seconds);
    // Lists of images have a name behind the time, as rgb.txt of TUM.
    const std::string_view next = columns.word();
    if (stamp_word(next) == next && stamp_number(next)) {
      throw wrong_columns(
          file, line, Format::automatic, "1: a time in seconds, or a time and a file name");
    }
    order.accepts(out.back(), word, line.number);
  }
  return out;
}

}  // namespace loopbench
