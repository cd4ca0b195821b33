#include "harness/commands/eval_options.hpp"

#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"

namespace loopbench {
namespace {

void declare_files(CLI::App& command, EvalArguments& a) {
  command
      .add_option("reference", a.reference, "The trajectory held to be true; or a folder (see EST)")
      ->required()
      ->type_name("REF");
  command
      .add_option("estimates",
                  a.estimates,
                  "The trajectories to judge. None: REF is a folder with stamped_groundtruth.txt "
                  "and stamped_traj_estimate*.txt. A folder ALGORITHM/DATASET/RUN.txt: REF is one "
                  "of DATASET.txt")
      ->type_name("EST");
  const auto word = [&](const char* name, std::string& value, const std::string& help) {
    return command.add_option(name, value, help)->type_name("WORD");
  };
  word("--format", a.format, choice_list<Format>())->capture_default_str();
  word("--ref-format", a.reference_format, "Format of REF, when it is another");
  command
      .add_option("--ref-body",
                  a.reference_body,
                  "Where REF's body (marker, IMU, camera) sits in the estimates', if elsewhere")
      ->type_name("X,Y,Z[,QX,QY,QZ,QW]");
  word("--repeats", a.repeats, "Equal stamps: " + choice_list<Repeats>())->capture_default_str();
  command.add_option("--times", a.times, "Stamps of KITTI poses, one a line")->type_name("FILE");
  command.add_option("--period", a.period, "Between KITTI or g2o poses without stamps [s]")
      ->type_name("S")
      ->check(finite_number())
      ->default_str(to_text(ReadOptions{}.period));
}

void declare_rules(CLI::App& command, EvalArguments& a) {
  command.add_option("--protocol", a.protocols, "Rules by name, see `list protocols`; several too")
      ->type_name("NAME")
      ->delimiter(',')
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->capture_default_str();
  command.add_option("--set", a.settings, "Change a field of the protocol")
      ->type_name("FIELD=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  // As evo's flag, and with a value: --align, --align sim3, --align=sim3.
  command.add_option("--align", a.align, choice_list<Align>() + "; alone: se3")
      ->expected(0, 1)
      ->default_str("se3")
      ->type_name("HOW");
  command.add_flag_callback(
      "-a", [&a] { a.align = "se3"; }, "As --align se3");
  command.add_flag_callback(
      "--align_origin", [&a] { a.align = "origin"; }, "As --align origin");
  command.add_flag("-s,--correct_scale", a.correct_scale, "Align with scale; alone: scale only");
  command.add_option("--n_to_align", a.align_first, "Align with the first pairs only");
  const auto word = [&](const char* name, std::string& value, const std::string& help) {
    return command.add_option(name, value, help)->type_name("WORD");
  };
  word("--association", a.association, choice_list<Association>());
  word("--project_to_plane", a.project, choice_list<Plane>());
  const auto seconds = [&](const char* name, std::optional<double>& value, const char* help) {
    command.add_option(name, value, help)->type_name("S")->check(finite_number());
  };
  seconds("--max-diff,--t_max_diff", a.max_diff, "Largest time difference of a pair");
  seconds("--max-gap", a.max_gap, "Largest reference gap to interpolate over");
  command
      .add_option("--min-coverage",
                  a.min_coverage,
                  "Share of poses and of the reference's time below which numbers are incomplete "
                  "(exit 1); by default half of what another estimate covers")
      ->type_name("SHARE")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 1.0));
  seconds("--offset,--t_offset", a.offset, "Added to the estimates' stamps");
}

}  // namespace

void declare(CLI::App& command, EvalArguments& a) {
  declare_files(command, a);
  declare_rules(command, a);
  command
      .add_option("-r,--pose_relation",
                  a.relation,
                  "Only ape and rpe in full, trans_part, rot_part, angle_deg, angle_rad, "
                  "point_distance, point_distance_error_ratio or rpy")
      ->type_name("WORD");
  command.add_option("-d,--delta", a.delta, "Stretch of rpe")
      ->type_name("NUMBER")
      ->check(finite_number());
  command.add_option("-u,--delta_unit", a.delta_unit, "f, s, m, d or r: frames, s, m, deg, rad")
      ->type_name("WORD");
  command.add_flag("--all_pairs", a.all_pairs, "rpe over all pairs");
  command.add_flag("--pairs_from_reference", a.pairs_from_reference, "rpe measured on REF");
  command.add_flag("--json", a.json, "As JSON in full precision: a list, one entry per judgement");
  command.add_flag("--csv", a.csv, "As CSV, in full precision")->excludes("--json");
  command
      .add_option(
          "--per-pose", a.per_pose, "Write the error of every pose as CSV; - is standard output")
      ->type_name("FILE");
}

}  // namespace loopbench
