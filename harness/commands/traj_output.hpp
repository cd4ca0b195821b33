/// Writes the trajectories of `traj`.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "harness/base/counted.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/traj_options.hpp"

namespace loopbench::harness {

using NamedTrajectories = std::vector<NamedTrajectory>;

inline std::vector<std::string> names_of(const NamedTrajectories& all) {
  std::vector<std::string> out;
  for (const NamedTrajectory& each : all) out.push_back(each.name);
  return out;
}

/// Rejects output files that are among the inputs.
inline void protect_inputs(const TrajArguments& a, const std::vector<std::string>& outputs) {
  std::vector<std::filesystem::path> inputs(a.files.begin(), a.files.end());
  inputs.emplace_back(a.reference);
  for (const std::string& file : outputs) {
    if (!is_dash(file)) reject_overwriting(inputs, file);
  }
}

/// Writes them to the files of the arguments (with --json none without -o), and says what a format
/// loses. Returns the exit code.
inline int write_all(const TrajArguments& a, const NamedTrajectories& all) {
  const Format format = written_format(a);
  if (a.json && is_dash(a.out)) return kExitOk;  // standard output is for JSON
  const std::vector<std::string> files = output_files(names_of(all), a.out, format);
  protect_inputs(a, files);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool loses_stamps =
        (format == Format::kitti || format == Format::g2o) && a.times_out.empty();
    const std::string assumed = assumed_period(all[i].file, a.reading);
    if (!loses_stamps && !assumed.empty()) {
      fmt::print(stderr,
                 "loopbench: {} has no stamps: {} (--period S)\n",
                 printable(all[i].name),
                 assumed);
    }
    if (loses_stamps && all[i].file.has_stamps) {
      fmt::print(stderr,
                 "loopbench: {} does not contain stamps{}\n",
                 to_text(format),
                 format == Format::kitti ? "; --times-out FILE writes them" : "");
    }
    if (!all[i].file.covariances.empty() && !has_covariances(all[i].file, format)) {
      fmt::print(stderr,
                 "loopbench: {} has covariances, which are not written: expected --to csv{}\n",
                 printable(all[i].name),
                 lacks_rotations(all[i].file.poses) ? "" : " or tum");
    }
    std::optional<std::filesystem::path> times;
    if (!a.times_out.empty()) times = a.times_out;
    if (times && all.size() > 1) throw InputError("--times-out: expected one trajectory");
    write_trajectory(files[i], all[i].file, format, times);
    if (!is_dash(files[i]) && !a.json) {
      fmt::print("{}: {}\n", printable(files[i]), counted(all[i].file.poses.size(), "pose"));
    }
  }
  return kExitOk;
}

/// Reads, changes and writes the files; exact stamps stay valid only if no stamp has changed.
inline int write_changed(const TrajArguments& a,
                         const std::function<void(NamedTrajectory&)>& change,
                         const NamedTrajectory* reference = nullptr) {
  NamedTrajectories all = read_all_named(a.files, a.reading, reference);
  for (NamedTrajectory& each : all) {
    const bool is_uncertain = !each.file.covariances.empty();
    change(each);
    if (is_uncertain && each.file.covariances.empty()) {
      fmt::print(stderr, "loopbench: {}: covariances are removed\n", printable(each.name));
    }
  }
  return write_all(a, all);
}

}  // namespace loopbench::harness
