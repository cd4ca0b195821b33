#include "harness/commands/eval/eval_options.hpp"

#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/commands/options.hpp"

namespace loopbench::harness {
namespace {

void declare_files(CLI::App& command, EvalArguments& a) {
  command.option_defaults()->group("Files");
  reads(command, add(command, "reference REF", a.reference, "Reference trajectory file"))
      ->required();
  reads(command, add(command, "estimates EST", a.estimates, "Trajectory files to evaluate"));
  declare_reading(command, a, {"--tf", "--all-topics"});
  add(command, "--ref-format", a.reference_format, "Format of REF, if different from --format");
  add(command,
      "--ref-body X,Y,Z[,QX,QY,QZ,QW]",
      a.reference_body,
      "Extrinsic offset of REF's body (marker, IMU, camera, prism, antenna) in the estimates' body "
      "frame [m]");
  command.add_flag("--ref-positions",
                   a.reference_positions,
                   "Ignore the rotations of REF (files of positions with filler quaternions)");
  add(command,
      "--ref-sigma M",
      a.reference_sigma,
      "Standard deviation of REF's positions, per axis [m]: errors and differences below it are "
      "reported as such, and nees adds it to stated covariances")
      ->check(number_between(0.0, 1e9));
  const auto file = [&](const char* name, std::string& value, const char* whose) {
    const std::string help = std::string("Covariances of ") + whose +
                             ": rows of a stamp and 6, 9, 21 or 36 numbers, one for each pose";
    reads(command, command.add_option(name, value, help))->type_name("FILE");
  };
  file("--cov", a.covariances, "EST");
  file("--ref-cov", a.reference_covariances, "REF");
  const auto seconds = [&](const char* name, std::optional<double>& value, const char* help) {
    command.add_option(name, value, help)->type_name("S")->check(finite_number());
  };
  seconds("--start,--t_start", a.start, "First stamp of REF to evaluate [s]");
  seconds("--end,--t_end", a.end, "Last stamp of REF to evaluate [s]");
  command.add_flag_callback(
      "--no-checks",
      [&a] { a.diagnose = false; },
      "Skip the checks of the files: mistakes that doctor finds, notes, diagnosis");
  declare_pose_filters(command, a.downsample, a.motion_filter);
}

/// A flag that sets a field of the protocol.
void declare_setting(CLI::App& command,
                     EvalArguments& a,
                     const std::string& option,
                     const std::string& setting,
                     const std::string& help) {
  command.add_flag_callback(
      option,
      [&a, setting, option] {
        a.settings.push_back({setting, option});
      },
      help);
}

void declare_pairing(CLI::App& command, EvalArguments& a) {
  command.option_defaults()->group("Pairing");
  declare_fields(command,
                 {{"association", "--association"},
                  {"max_diff", "--max-diff,--t_max_diff"},
                  {"offset", "--offset,--t_offset"}},
                 a.settings);
  command.get_option("--association")
      ->description(
          "Pairing in time (nearest: one-to-one, smallest differences first; evo: nearest, but a "
          "pose can be paired twice; tum: greedy by difference, as associate.py; interpolate: the "
          "reference at the estimate's stamps; interpolate_estimate: the estimate at the "
          "reference's stamps, for control points and GNSS; index: equal indices, stamps ignored)");
  add(command,
      "--min-coverage SHARE",
      a.min_coverage,
      "Minimum share of poses and of the reference's time, below which results are incomplete "
      "(exit 1); default: 0.1, and at least half of the largest coverage of the estimates; with "
      "--store 0.5")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 1.0));
  add(command,
      "--common WORD",
      a.common,
      "Evaluate only the times that all estimates of REF cover: yes or no (default: yes with "
      "--store)")
      ->transform(one_of<bool>("answer", {{"yes", true}, {"no", false}}));
}

void declare_alignment(CLI::App& command, EvalArguments& a) {
  command.option_defaults()->group("Alignment");
  declare_fields(command,
                 {{"align", "--align"},
                  {"align_first", "--n_to_align"},
                  {"planar", "--planar"},
                  {"project", "--project_to_plane"}},
                 a.settings);
  command.get_option("--planar")
      ->description(
          "Restrict se3 and sim3 to x, y and yaw. auto: if both trajectories are in one plane "
          "within rounding; yes: both are moved to their planes");
  // As evo's flag, or with a value: --align, --align sim3, --align=sim3.
  CLI::Option* align = command.get_option("--align");
  align->expected(0, 1)->default_str("se3");
  align->description(align->get_description() + " (without value: se3)");
  declare_setting(command, a, "-a", "align=se3", "Short for --align se3");
  declare_setting(command, a, "--align_origin", "align=origin", "Short for --align origin");
  reads(command,
        add(command,
            "--parts FILE",
            a.parts,
            "Align and evaluate parts of each estimate separately: auto (new maps, jumps of the "
            "frame, frozen poses, as doctor finds them), or a file with the first, or the first "
            "and last, stamp of each part"));
  command.add_flag("-s,--correct_scale",
                   a.correct_scale,
                   "Also align the scale; without --align only the scale");
}

void declare_metrics(CLI::App& command, EvalArguments& a) {
  command.option_defaults()->group("Metrics");
  add(command, "--protocol PROTOCOL", a.protocols, "Evaluation protocols, see `list protocols`")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  const auto set = [&a](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) a.settings.push_back({text});
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--set", set, "Field of the protocol to change, see `list protocols`")
      ->type_name("FIELD=VALUE")
      ->allow_extra_args(false);
  auto* metric = add(command,
                     "--metric METRIC",
                     a.metrics,
                     "Metric to evaluate instead of the default ones, see `list metrics`; options "
                     "follow a colon (rpe:delta=5,unit=m); repeat for several")
                     ->allow_extra_args(false);
  command.add_flag(
      "--end-error",
      a.end_error,
      "Evaluate the error at the end of loops instead, without a reference: every file, "
      "also the first, should end where it began");
  add(command, "--plugin FILE", a.plugins, "Shared object with additional metrics")
      ->allow_extra_args(false);
  command
      .add_option("-r,--pose_relation", a.relation, "Evaluate only ape and rpe, in this relation")
      ->type_name(
          "WORD:full|trans_part|rot_part|angle_deg|angle_rad|point_distance|point_distance_error_"
          "ratio|rpy")
      ->excludes(metric);
  add(command,
      "-d,--delta NUMBER",
      a.delta,
      "Distance between paired poses for rpe, in --delta_unit")
      ->excludes(metric)
      ->check(finite_number());
  add(command,
      "-u,--delta_unit WORD:f|s|m|d|r",
      a.delta_unit,
      "Unit of --delta (frames, s, m, deg, rad)")
      ->excludes(metric);
  declare_setting(command, a, "--all_pairs", "pairs=all", "Use all pairs for rpe");
}

void declare_output(CLI::App& command, EvalArguments& a) {
  command.option_defaults()->group("Output");
  add(command,
      "--unit,--change_unit WORD:mm|cm|m|km|deg|rad",
      a.unit,
      "Unit of lengths (mm, cm, m, km) or angles (deg, rad) in the results");
  command.add_flag("--full", a.full, "Print all statistics, single axes and the diagnosis");
  command.add_flag("--json", a.json, "Print JSON in full precision, one list entry per evaluation");
  command
      .add_flag(
          "--csv", a.csv, "Print a CSV line per score in full precision, as `export --what rows`")
      ->excludes("--json");
  const auto file = [&](const char* name, std::string& value, FileKind kind, const char* help) {
    return writes(command, add(command, name, value, help), kind);
  };
  file("-o,--out FILE",
       a.out,
       FileKind::printed,
       "File for what is printed (default: standard output)");
  file("--per-pose FILE",
       a.per_pose,
       FileKind::printed,
       "CSV file for the error of every pose, and per-pose values of metrics; - is standard "
       "output, with the results on standard error");
  file("--plot,--save_plot FILE",
       a.plot,
       FileKind::figure,
       "Page with all figures: .pdf, .svg, .png or .pgf (default: FILE.pdf); for single figures, "
       "other sizes and styles see `plot`");
  file("--report FILE",
       a.report,
       FileKind::page,
       "HTML page with tables, verdicts and figures, as `report` writes it");
  add(command,
      "--store DIR",
      a.store,
      "Folder for a store of the results, for compare, table, report, plot and check; each call "
      "adds runs. NAME_3.txt, NAME/3.txt and, for reference SEQUENCE.txt, NAME/SEQUENCE/3.txt are "
      "run 3 of system NAME")
      ->excludes("--json")
      ->excludes("--csv")
      ->excludes("--unit")
      ->excludes("--per-pose");
  add(command, "--sequence NAME", a.sequence, "Label of REF in the store (default: from its name)")
      ->needs("--store");
  add(command,
      "--group NAME",
      a.group,
      "Recording of REF; sequences of one recording are not independent (default: references with "
      "the same positions form a group)")
      ->needs("--store");
}

}  // namespace

void declare(CLI::App& command, EvalArguments& a) {
  declare_files(command, a);
  declare_pairing(command, a);
  declare_alignment(command, a);
  declare_metrics(command, a);
  declare_output(command, a);
  declare_daily(command,
                {"--format",
                 "--max-diff",
                 "--align",
                 "--correct_scale",
                 "--protocol",
                 "--metric",
                 "--full",
                 "--plot",
                 "--report",
                 "--store"});
}

}  // namespace loopbench::harness
