#include "harness/commands/options.hpp"

#include <algorithm>
#include <cctype>

#include "harness/commands/checks.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::harness {
namespace {

/// Type of an option for this field, with the words of an enum.
std::string value_type(const OptionInfo& field) {
  if (std::holds_alternative<std::int64_t>(field.value)) return "INT";
  if (!field.is_text) return field.help.ends_with("[s]") ? "S" : "FLOAT";
  std::string words = field.rule;
  std::erase(words, ' ');
  return words.empty() ? "TEXT" : "WORD:" + words;
}

}  // namespace

void declare_reading(CLI::App& command,
                     ReadArguments& reading,
                     const std::vector<std::string>& without) {
  command.add_option("-f,--format", reading.format, "Format of the files")
      ->type_name("WORD")
      ->transform(words_of<Format>("format"));
  command.add_option("--times", reading.times, "Times of KITTI poses, one per line [s]")
      ->type_name("FILE");
  command.add_option("--period", reading.period, "Time between poses without stamps [s]")
      ->check(finite_number());
  command.add_option("--repeats", reading.repeats, "Poses with a repeated stamp")
      ->type_name("WORD")
      ->transform(words_of<Repeats>("repeats"));
  command.add_option("--tf", reading.tf, "Frames in the TF tree of bags without a topic")
      ->type_name("PARENT.CHILD");
  command.add_flag("--all-topics", reading.all_topics, "All trajectories of bags without a topic");
  for (const std::string& name : without) command.remove_option(command.get_option(name));
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
  command.add_option("--downsample", downsample, "Evenly spaced poses to keep of each file")
      ->type_name("N")
      ->check(positive_number());
  command
      .add_option("--motion_filter",
                  motion_filter,
                  "Keep only poses that are this path length [m] or this angle [deg] from the "
                  "pose kept before, in each file")
      ->type_name("M DEG")
      ->expected(2)
      ->allow_extra_args(false)
      ->check(number_between(0.0, 1e9));
}

void declare_curves(CLI::App& command, FigureOptions& options) {
  command
      .add_option("--labels",
                  options.labels,
                  "Comma-separated names of the estimates in the legend, in their order")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      .add_option(
          "--plane", options.plane, "Plane of the map: xy, xz or yz; default: the largest extent")
      ->check(CLI::IsMember({"xy", "xz", "yz"}))
      ->type_name("WORD");
}

void declare_figures(CLI::App& command, FigureOptions& options, const std::string& needs) {
  declare_curves(command, options);
  const std::vector<CLI::Option*> of_files{
      command
          .add_option("--style",
                      options.style,
                      "Comma-separated style sheets of matplotlib, files or names, for fonts, "
                      "colours and lines")
          ->delimiter(',')
          ->type_name("FILE_OR_NAME"),
      command
          .add_option("--size", options.size, "Width and height of a panel [in]; default: 3.5,2.8")
          ->delimiter(',')
          ->check(CLI::Range(0.5, 50.0))
          ->type_name("WIDTH,HEIGHT"),
      command.add_option("--font", options.font, "Font size [pt]; default: that of --style, or 8")
          ->check(CLI::Range(2.0, 100.0))
          ->type_name("PT"),
      command
          .add_option(
              "--panel-columns", options.columns, "Panels in a row; default: 2; of traj plot 3")
          ->check(CLI::Range(1, 10))
          ->type_name("N"),
      command.add_flag(
          "--script",
          options.script,
          "Also write each figure's data (.json) and the Python script (.py) that draws them")};
  for (CLI::Option* const option : of_files) {
    if (!needs.empty()) option->needs(needs);
  }
}

}  // namespace loopbench::harness
