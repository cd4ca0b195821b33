#include "harness/commands/eval_options.hpp"

#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/figure_options.hpp"

namespace loopbench::harness {
namespace {

void declare_files(CLI::App& command, EvalArguments& a) {
  command.add_option("reference", a.reference, "Reference trajectory file")
      ->required()
      ->type_name("REF");
  command.add_option("estimates", a.estimates, "Trajectory files to evaluate")
      ->required()
      ->type_name("EST");
  command.add_option("--format", a.format, "File format")
      ->type_name(choice_type<Format>())
      ->capture_default_str();
  command
      .add_option(
          "--ref-format", a.reference_format, "File format of REF, if different from --format")
      ->type_name(choice_type<Format>());
  command
      .add_option("--ref-body",
                  a.reference_body,
                  "Extrinsic offset of REF's body (marker, IMU, camera, prism, antenna) in the "
                  "estimates' body frame [m]")
      ->type_name("X,Y,Z[,QX,QY,QZ,QW]");
  command.add_flag("--ref-positions",
                   a.reference_positions,
                   "Ignore the rotations of REF (files of positions with filler quaternions)");
  command
      .add_option(
          "--ref-sigma",
          a.reference_sigma,
          "Standard deviation of REF's positions, per axis [m]: errors and differences below "
          "it are reported as such, and nees adds it to stated covariances")
      ->type_name("M")
      ->check(number_between(0.0, 1e9));
  const auto file = [&](const char* name, std::string& value, const char* whose) {
    const std::string help = std::string("Covariances of ") + whose +
                             ": rows of a stamp and 6, 9, 21 or 36 numbers, one for each pose";
    command.add_option(name, value, help)->type_name("FILE");
  };
  file("--cov", a.covariances, "EST");
  file("--ref-cov", a.reference_covariances, "REF");
  command
      .add_option("--repeats",
                  a.repeats,
                  "Handling of equal stamps; default: refuse, or all are kept if every protocol "
                  "pairs as evo does")
      ->type_name(choice_type<Repeats>());
  command.add_option("--times", a.times, "Times file for KITTI poses, one stamp per line [s]")
      ->type_name("FILE");
  command.add_option("--period", a.period, "Time between KITTI or g2o poses without stamps [s]")
      ->type_name("S")
      ->check(finite_number())
      ->default_str(to_text(ReadOptions{}.period));
  const auto seconds = [&](const char* name, std::optional<double>& value, const char* help) {
    command.add_option(name, value, help)->type_name("S")->check(finite_number());
  };
  seconds("--start,--t_start", a.start, "First stamp of REF to evaluate [s]");
  seconds("--end,--t_end", a.end, "Last stamp of REF to evaluate [s]");
  declare_pose_filters(command, a.downsample, a.motion_filter);
}

void declare_rules(CLI::App& command, EvalArguments& a) {
  command.add_option("--protocol", a.protocols, "Evaluation protocols, see `list protocols`")
      ->type_name("PROTOCOL")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command.add_option("--set", a.settings, "Field of the protocol to change")
      ->type_name("FIELD=VALUE")
      ->allow_extra_args(false);
  // As evo's flag, or with a value: --align, --align sim3, --align=sim3.
  auto* align = command.add_option("--align", a.align, "Alignment (without value: se3)")
                    ->expected(0, 1)
                    ->default_str("se3")
                    ->type_name(choice_type<metrics::Align>());
  auto* rigid = command.add_flag_callback(
      "-a", [&a] { a.align = "se3"; }, "Short for --align se3");
  command
      .add_flag_callback(
          "--align_origin", [&a] { a.align = "origin"; }, "Short for --align origin")
      ->excludes(align)
      ->excludes(rigid);
  command.add_flag("-s,--correct_scale",
                   a.correct_scale,
                   "Also align the scale; without --align only the scale");
  const auto field = [&](const char* option, const char* name, const std::string& help) {
    const auto set = [&a, name](const std::string& value) {
      a.fields.push_back(std::string(name) + "=" + value);
    };
    return command.add_option_function<std::string>(option, set, help)->type_name("WORD");
  };
  const auto seconds = [&](const char* option, const char* name, const char* help) {
    field(option, name, help)->type_name("S")->check(finite_number());
  };
  field("--n_to_align", "align_first", "Number of first pairs used for the alignment")
      ->type_name("INT");
  field("--association", "association", "Association in time")
      ->type_name(choice_type<metrics::Association>());
  field("--project_to_plane", "project", "Plane to project onto")
      ->type_name(choice_type<metrics::ProjectionPlane>());
  seconds(
      "--max-diff,--t_max_diff", "max_diff", "Maximum time difference between paired poses [s]");
  seconds("--max-gap", "max_gap", "Longest reference gap to interpolate across [s]");
  command
      .add_option("--min-coverage",
                  a.min_coverage,
                  "Minimum share of poses and of the reference's time, below which results are "
                  "incomplete (exit 1); default: a tenth, and half of the largest coverage of the "
                  "estimates; with --store 0.5")
      ->type_name("SHARE")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 1.0));
  seconds("--offset,--t_offset", "offset", "Time offset added to the estimates' stamps [s]");
}

}  // namespace

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

void declare(CLI::App& command, EvalArguments& a) {
  declare_files(command, a);
  declare_rules(command, a);
  auto* metric =
      command
          .add_option("--metric",
                      a.metrics,
                      "Metric to evaluate instead of the default ones, see `list metrics`; options "
                      "follow a colon (rpe:delta=5,unit=m); repeat for several")
          ->type_name("METRIC")
          ->allow_extra_args(false);
  command.add_option("--plugin", a.plugins, "Shared object with additional metrics")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("-r,--pose_relation", a.relation, "Evaluate only ape and rpe, in this relation")
      ->type_name(
          "WORD:full|trans_part|rot_part|angle_deg|angle_rad|point_distance|"
          "point_distance_error_ratio|rpy")
      ->excludes(metric);
  command
      .add_option("-d,--delta", a.delta, "Distance between paired poses for rpe, in --delta_unit")
      ->type_name("NUMBER")
      ->excludes(metric)
      ->check(finite_number());
  command.add_option("-u,--delta_unit", a.delta_unit, "Unit of --delta (frames, s, m, deg, rad)")
      ->type_name("WORD:f|s|m|d|r")
      ->excludes(metric);
  const auto flag = [&](const char* option, const char* setting, const char* help) {
    command.add_flag_callback(
        option, [&a, setting] { a.fields.emplace_back(setting); }, help);
  };
  command
      .add_option("--unit,--change_unit",
                  a.unit,
                  "Unit of lengths (mm, cm, m, km) or angles (deg, rad) in the results")
      ->type_name("WORD:mm|cm|m|km|deg|rad");
  command
      .add_option("--columns",
                  a.columns,
                  "Comma-separated columns of the table, or of --csv, by their headings with or "
                  "without unit (ate,rpe_1_s,coverage)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAMES");
  command.add_flag("--full", a.full, "Print all statistics, single axes and the diagnosis");
  flag("--all_pairs", "pairs=all", "Use all pairs for rpe");
  flag("--pairs_from_reference",
       "pairs_from=reference",
       "Measure --delta along REF instead of the estimate");
  command.add_flag("--json", a.json, "Print JSON in full precision, one list entry per evaluation")
      ->excludes("--columns");
  command
      .add_flag(
          "--csv", a.csv, "Print a CSV line per score in full precision, as `export --what rows`")
      ->excludes("--json");
  command
      .add_option("--per-pose",
                  a.per_pose,
                  "CSV file for the error of every pose, and per-pose values of metrics; - is "
                  "standard output")
      ->type_name("FILE");
  command
      .add_option(
          "--plot,--save_plot",
          a.plot,
          "Figures PREFIX_trajectories, PREFIX_errors and PREFIX_axes as .svg, .pdf and .png, or "
          "as .pgf for PREFIX.pgf (likewise .svg, .pdf, .png), by default as wide as one column "
          "of a paper (3.5 in)")
      ->type_name("PREFIX");
  declare_figure_options(command, a.figures, "--plot");
  command
      .add_option("--report",
                  a.report,
                  "HTML page with tables, verdicts and figures, as `report` writes it")
      ->type_name("FILE");
  command
      .add_option("--store",
                  a.store,
                  "Folder for a store of the results, for compare, table, report, plot and check: "
                  "NAME_3.txt and NAME/3.txt are run 3 of method NAME. Later calls add runs")
      ->type_name("DIR")
      ->excludes("--json")
      ->excludes("--csv")
      ->excludes("--columns")
      ->excludes("--unit")
      ->excludes("--per-pose");
  command
      .add_option("--sequence", a.sequence, "Label of REF in the store (default: from its name)")
      ->type_name("NAME")
      ->needs("--store");
  command
      .add_option("--group",
                  a.group,
                  "Recording of REF: sequences of one recording are not independent (default: by "
                  "the poses of the references)")
      ->type_name("NAME")
      ->needs("--store");
  command
      .add_option("--common",
                  a.common,
                  "Evaluate only the times that all estimates of REF cover: yes or no (default: "
                  "yes with --store)")
      ->transform(one_of<bool>("answer", {{"yes", true}, {"no", false}}))
      ->type_name("WORD");
  command.add_flag("--paired", a.paired, "Pair runs of equal names in verdicts");
}

}  // namespace loopbench::harness
