#include "harness/commands/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "harness/commands/checks.hpp"
#include "harness/sweep/text/printable.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::harness {
namespace {

/// Type of an option for this field, with the words of an enum.
std::string value_type(const OptionInfo& field) {
  if (std::holds_alternative<std::int64_t>(field.value)) return "INT";
  if (!field.is_text) return unit_in(field.help) == "s" ? "S" : "FLOAT";
  return field.words.empty() ? "TEXT" : fmt::format("WORD:{}", fmt::join(field.words, "|"));
}

}  // namespace

std::string unit_in(const std::string& help) {
  const std::size_t begin = help.find('[');
  const std::size_t end = help.find(']', begin);
  const bool is_one = end != std::string::npos && help.find('[', end) == std::string::npos;
  return is_one ? help.substr(begin + 1, end - begin - 1) : "";
}

void declare_reading(CLI::App& command,
                     ReadArguments& reading,
                     const std::vector<std::string>& without) {
  add(command, "-f,--format", reading.format, "Format of the files");
  const char* const times = "Times of poses without stamps, one per line [s]";
  reads(command, add(command, "--times FILE", reading.times, times));
  command.add_option("--period", reading.period, "Time between poses without stamps [s]")
      ->check(finite_number());
  add(command, "--stamp-unit", reading.stamp_unit, "Unit of stamps, if the file does not name it");
  add(command, "--repeats", reading.repeats, "How to treat poses with a repeated stamp");
  command.add_flag("--sort", reading.sort, "Sort rows that are not in order of time");
  command.add_flag("--drop-invalid",
                   reading.drop_invalid,
                   "Drop rows with numbers that are not finite, or zero quaternions");
  add(command, "--tf PARENT.CHILD", reading.tf, "Frames in the TF tree of bags without a topic");
  command.add_flag("--all-topics", reading.all_topics, "All trajectories of bags without a topic");
  for (const std::string& name : without) remove_option(command, name);
}

void declare_fields(CLI::App& command,
                    const std::vector<FieldOption>& options,
                    std::vector<GivenSetting>& given) {
  for (const OptionInfo& field : describe(metrics::Protocol{})) {
    const auto found = std::ranges::find(options, field.name, &FieldOption::field);
    if (found == options.end()) continue;
    std::string help = field.help;
    help.front() = static_cast<char>(std::toupper(help.front()));
    const std::string first = found->names.substr(0, found->names.find(','));
    const auto set = [&given, name = field.name, first](const std::string& value) {
      given.push_back({name + "=" + value, first});
    };
    auto* option = command.add_option_function<std::string>(found->names, set, help)
                       ->type_name(value_type(field));
    if (std::holds_alternative<double>(field.value)) option->check(finite_number());
  }
}

void declare_pose_filters(CLI::App& command,
                          std::optional<std::size_t>& downsample,
                          std::vector<double>& motion_filter) {
  add(command, "--downsample N", downsample, "Number of evenly spaced poses to keep per file")
      ->check(positive_number());
  add(command,
      "--motion_filter M DEG",
      motion_filter,
      "Keep only poses that are this path length [m] or this angle [deg] from the pose kept "
      "before, in each file")
      ->expected(2)
      ->allow_extra_args(false)
      ->check(number_between(0.0, 1e9));
}

void declare_problem(CLI::App& command, CorrectArguments& problem) {
  reads(command,
        add(command, "estimate ESTIMATE", problem.estimate, "Trajectory file, or a g2o graph"))
      ->required();
  reads(
      command,
      add(command,
          "--loops FILE",
          problem.loops,
          "Loop closures: stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r], the pose of "
          "the body at stamp_to in the body frame at stamp_from [s, m, rad]; or a g2o graph whose "
          "vertices are the poses of ESTIMATE"));
  command
      .add_option_function<std::vector<std::string>>(
          "--break",
          [&problem](const std::vector<std::string>& given) {
            problem.settings.push_back(
                {fmt::format("breaks={}", fmt::join(given, " ")), "--break"});
          },
          "The estimate starts again at this pose (a new map, a robot that was carried): the "
          "motion to this pose is unknown; repeatable")
      ->type_name("STAMP|ID")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* const set =
      command
          .add_option_function<std::vector<std::string>>(
              "--set",
              [&problem](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) problem.settings.push_back({text});
              },
              "Option of dataset trajectory (or pose_graph for a graph), see `list datasets`")
          ->type_name("OPTION=VALUE")
          ->expected(1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  reads(command, set);
}

void declare_figures(CLI::App& command, FigureOptions& options, const std::string& needs) {
  add(command,
      "--labels NAMES",
      options.labels,
      "Comma-separated names of the estimates in the legend, in their order")
      ->delimiter(',');
  add(command,
      "--plane WORD",
      options.plane,
      "Plane of the map: xy, xz or yz; default: that of the largest extent")
      ->check(CLI::IsMember({"xy", "xz", "yz"}));
  const std::vector<CLI::Option*> of_files{
      add(command,
          "--style FILE_OR_NAME",
          options.style,
          "Comma-separated style sheets of matplotlib, files or names, for fonts, colours and "
          "lines")
          ->delimiter(','),
      add(command,
          "--size WIDTH,HEIGHT",
          options.size,
          "Width and height of a panel [in]; default: 3.5,2.8")
          ->delimiter(',')
          ->check(CLI::Range(0.5, 50.0)),
      add(command, "--font PT", options.font, "Font size [pt]; default: that of --style, or 8")
          ->check(CLI::Range(2.0, 100.0)),
      add(command,
          "--panel-columns N",
          options.columns,
          "Panels in a row; default: 2 (traj plot: 3)")
          ->check(CLI::Range(1, 10)),
      command.add_flag(
          "--script",
          options.script,
          "Also write each figure's data (.json) and the Python script (.py) that draws them")};
  for (CLI::Option* const option : of_files) {
    if (!needs.empty()) option->needs(needs);
  }
}

void draw_map(FigureData data, const std::filesystem::path& name, const FigureOptions& options) {
  const DrawnFigure figure{{figure_name(name)}, {"plane"}, options};
  data.figures.push_back(figure);
  draw({data});
  fmt::print(stderr, "{}", printable(file_list(figure)));
}

}  // namespace loopbench::harness
