#include "datasets/formats/times.hpp"

#include <fmt/format.h>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/formats/detect_format.hpp"

namespace loopbench {

void set_stamps(const TextFile& file, const ReadOptions& options, Trajectory& poses) {
  if (!options.times) {
    for (StampedPose& pose : poses) pose.stamp *= options.period;
    return;
  }
  const std::vector<double> times = read_times(*options.times, options);
  const std::size_t rows = poses.size() + file.repaired.invalid;
  const auto last = static_cast<std::size_t>(poses.back().stamp);
  const bool by_rows = file.repaired.clock == Clock::rows;
  if (by_rows ? times.size() != rows : times.size() <= last) {
    throw file.error(
        0,
        fmt::format("has {}, but {} has {} times, expected {}",
                    by_rows ? fmt::format("{} poses", rows) : fmt::format("frame {}", last),
                    options.times->string(),
                    times.size(),
                    by_rows ? "equal numbers" : "one for each frame from 0 on"));
  }
  for (StampedPose& pose : poses) pose.stamp = times[static_cast<std::size_t>(pose.stamp)];
  file.repaired.clock = Clock::stamps;
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
    if (!columns.done()) throw wrong_columns(file, line, Format::automatic, "1: a time in seconds");
    order.accepts(out.back(), word, line.number);
  }
  return out;
}

}  // namespace loopbench
