#include "harness/commands/traj/traj_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/commands/commands.hpp"
#include "harness/commands/output_files.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

std::vector<std::string> names_of(const NamedTrajectories& all) {
  std::vector<std::string> out;
  for (const NamedTrajectory& each : all) out.push_back(each.name);
  return out;
}

/// Which rows of the input are not written, if later rows thereby move up; otherwise empty.
std::string missing_rows(const ReadFindings& findings) {
  constexpr std::size_t kMost = 10;
  const std::vector<std::size_t>& dropped = findings.dropped;
  if (dropped.empty()) return "";
  const std::size_t shown = std::min(dropped.size(), kMost);
  return fmt::format(
      "invalid rows are not written, so that later rows move up: {} of {}, rows {}{} "
      "(from 0 on)",
      dropped.size(),
      findings.rows,
      fmt::join(dropped.begin(), dropped.begin() + static_cast<long>(shown), ", "),
      dropped.size() > shown ? ", ..." : "");
}

}  // namespace

int write_all(const TrajArguments& a, const NamedTrajectories& all) {
  const Format format = written_format(a.out, a.to);
  if (a.json && is_dash(a.out)) return kExitOk;  // standard output is for JSON
  const std::vector<std::string> files = output_files(names_of(all), a.out, format);
  if (std::filesystem::is_directory(a.out)) {
    std::vector<OutputFile> outputs;
    for (const std::string& file : files) outputs.push_back({"--out", file, FileKind::trajectory});
    require_writable(outputs);
  }
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
    const std::string missing = missing_rows(all[i].findings);
    if (loses_stamps && !missing.empty()) {
      fmt::print(stderr, "loopbench: {}: {}\n", printable(all[i].name), missing);
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

int write_changed(const TrajArguments& a,
                  const std::function<void(NamedTrajectory&)>& change,
                  const NamedTrajectory* reference) {
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
