#include <fmt/format.h>

#include "datasets/core/fields.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "datasets/formats/tum.hpp"
#include "datasets/formats/written_rows.hpp"

namespace loopbench {
namespace {

TextWriter times_text(const TrajectoryFile& file) {
  TextWriter out;
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_stamp(out, file, i);
    out.end_line();
  }
  return out;
}

/// "tum, kitti, euroc, g2o or csv": names of formats for which `is_wanted` holds.
template <class Wanted>
std::string names_of_formats(Wanted is_wanted) {
  std::vector<std::string> names;
  for (const auto& [name, format] : choices(Format{})) {
    if (format != Format::automatic && is_wanted(entry_of(format))) names.emplace_back(name);
  }
  std::string out = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) {
    out += (i + 1 < names.size() ? ", " : " or ") + names[i];
  }
  return out;
}

}  // namespace

bool has_covariances(const TrajectoryFile& file, Format format) {
  if (file.covariances.empty()) return false;
  const FormatContents contents = entry_of(format).contents;
  return lacks_rotations(file.poses) ? contents.position_covariances : contents.covariances;
}

bool can_write(Format format) {
  return format != Format::automatic && entry_of(format).write != nullptr;
}

void write_trajectory(const std::filesystem::path& file,
                      const TrajectoryFile& trajectory,
                      Format format,
                      const std::optional<std::filesystem::path>& times) {
  check(trajectory.poses, file.string(), Rotations::optional);
  if (!can_write(format)) {
    throw InputError("format: found " + to_text(format) + ", expected " +
                     names_of_formats([](const FormatEntry& e) { return e.write != nullptr; }));
  }
  const FormatEntry& entry = entry_of(format);
  if (lacks_rotations(trajectory.poses) && !entry.contents.positions) {
    throw InputError(file.string() + ": " + to_text(format) + " needs rotations, expected " +
                     names_of_formats([](const FormatEntry& e) { return e.contents.positions; }) +
                     " for positions without rotation");
  }
  entry.write(trajectory, file.string()).save(file);
  if (times) times_text(trajectory).save(*times);
}

void write_tum(const std::filesystem::path& file,
               const TrajectoryFile& trajectory,
               const std::vector<std::string>& comments) {
  check(trajectory.poses, file.string());
  tum_text(trajectory, comments).save(file);
}

void write_tum(const std::filesystem::path& file,
               const Trajectory& trajectory,
               const std::vector<std::string>& comments) {
  write_tum(file, TrajectoryFile{trajectory}, comments);
}

}  // namespace loopbench
