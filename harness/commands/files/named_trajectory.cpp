#include "harness/commands/files/named_trajectory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/core/fields.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

bool is_bag_without_topic(const std::string& name) {
  if (names_bag(name)) return bag_name(name).topic.empty();
  if (std::filesystem::is_directory(name)) return true;  // of ROS 2; others are rejected by name
  return bag_kind(open_input(name)) != BagKind::none;
}

const char* extension(Format format) {
  if (format == Format::g2o) return ".g2o";
  return format == Format::euroc || format == Format::csv ? ".csv" : ".txt";
}

}  // namespace

std::vector<std::string> expanded_names(const std::vector<std::string>& names,
                                        const ReadArguments& arguments) {
  if (arguments.tf.empty() && !arguments.all_topics) return names;
  std::vector<std::string> out;
  bool has_bag = false;
  for (const std::string& name : names) {
    if (!is_bag_without_topic(name)) {
      out.push_back(name);
      continue;
    }
    has_bag = true;
    const std::string file = file_of(name);
    if (!arguments.tf.empty()) out.push_back(to_text(BagName{file, "tf:" + arguments.tf}));
    if (!arguments.all_topics) continue;
    for (const BagTopic& topic : bag_topics(file).topics) {
      const bool is_pose = topic.type != MessageType::tf && !has_only_positions(topic.type);
      if (is_pose) out.push_back(to_text(BagName{file, topic.name}));
    }
  }
  if (!has_bag) throw InputError("--tf, --all-topics: expected a bag without a topic");
  if (out.empty()) throw InputError("--all-topics: found no topics with poses");
  return out;
}

ReadOptions read_options(const ReadArguments& arguments) {
  ReadOptions out{.format = arguments.format,
                  .sort = arguments.sort,
                  .drop_invalid = arguments.drop_invalid,
                  .stamp_unit = arguments.stamp_unit,
                  .positions = true};
  out.repeats = arguments.repeats.value_or(out.repeats);
  out.period = arguments.period.value_or(out.period);
  return out;
}

NamedTrajectory read_named(const std::string& name, const ReadArguments& arguments) {
  NamedTrajectory out;
  out.name = name;
  ReadOptions options = read_options(arguments);
  if (!arguments.times.empty()) options.times = arguments.times;
  options.findings = &out.findings;
  out.file = read_trajectory_file(name, options);
  if (out.file.poses.empty()) throw InputError(name + ": has no poses, expected at least one");
  require_clear_unit(name, out.findings);
  if (!out.findings.damage.empty()) {
    fmt::print(
        stderr, "{}\n", printable("loopbench: warning: " + name + ": " + out.findings.damage));
  }
  return out;
}

std::vector<NamedTrajectory> read_all_named(const std::vector<std::string>& names,
                                            const ReadArguments& arguments,
                                            const NamedTrajectory* reference) {
  std::vector<NamedTrajectory> out;
  bool has_unstamped = reference != nullptr && !reference->file.has_stamps;
  for (const std::string& name : expanded_names(names, arguments)) {
    out.push_back(read_named(name, arguments));
    has_unstamped = has_unstamped || !out.back().file.has_stamps;
  }
  if (arguments.period && !has_unstamped) {
    throw InputError("--period " + to_text(*arguments.period) +
                     ": all files have stamps, expected KITTI poses without --times, or g2o");
  }
  return out;
}

void shift_stamps(TrajectoryFile& file, double offset) {
  const auto nanoseconds = static_cast<std::int64_t>(std::llround(offset * 1e9));
  for (StampedPose& pose : file.poses) pose.stamp += offset;
  for (std::int64_t& stamp : file.nanoseconds) stamp += nanoseconds;
}

void reject_two_clocks(const NamedTrajectory& a,
                       const NamedTrajectory& b,
                       const ReadArguments& arguments) {
  const auto clock_of = [](const NamedTrajectory& each) {
    return FileClock{
        each.name, each.findings.clock, each.file.poses.size() + each.findings.invalid};
  };
  if (a.file.has_stamps != b.file.has_stamps && arguments.period) return;
  const std::string why = why_no_common_time(clock_of(a), clock_of(b));
  if (!why.empty()) throw InputError(why);
}

std::string assumed_period(const TrajectoryFile& file, const ReadArguments& arguments) {
  if (file.has_stamps || arguments.period) return "";
  return fmt::format("assumed {:g} s between poses", ReadOptions{}.period);
}

std::string plain_stem(const std::string& name) {
  if (names_bag(name) && !bag_name(name).topic.empty()) {
    const std::string topic = bag_name(name).topic;
    return topic.starts_with('/') ? topic.substr(1) : topic;
  }
  std::filesystem::path path(file_of(name));
  while (path.extension() == ".gz" || path.extension() == ".zst") path = path.stem();
  return path.stem().string();
}

std::string output_stem(const std::string& name) {
  const std::string stem = name == "-" ? "standard_input" : plain_stem(name);
  std::string out;
  for (const char c : stem) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
    if (is_plain) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  return out.empty() ? "trajectory" : out;
}

std::vector<std::string> output_files(const std::vector<std::string>& names,
                                      const std::string& out,
                                      Format format) {
  const bool is_folder =
      !is_dash(out) && (out.ends_with('/') || std::filesystem::is_directory(out));
  if (names.size() == 1 && !is_folder) return {out};
  if (is_dash(out)) throw InputError("-o: found several trajectories, expected a folder");
  const std::string ending = std::filesystem::path(out).extension().string();
  const bool names_file =
      ending == ".txt" || ending == ".tum" || ending == ".csv" || ending == ".g2o";
  if (names_file && !is_folder) {
    throw InputError("-o: found several trajectories and the file " + out +
                     ", expected a folder (" + out + "/ is one)");
  }
  std::filesystem::create_directories(out);
  std::vector<std::string> files;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    files.push_back(
        (std::filesystem::path(out) / (output_stem(name) + extension(format))).string());
    if (!taken.insert(files.back()).second) {
      throw InputError("-o: " + files.back() + " would be written twice, the second time for " +
                       name);
    }
  }
  return files;
}

}  // namespace loopbench::harness
