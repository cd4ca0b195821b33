#include "harness/commands/traj/traj_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "datasets/core/fields.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/options.hpp"
#include "harness/sweep/model/where.hpp"

namespace loopbench::harness {
namespace {

void declare_inputs(CLI::App& verb, TrajArguments& a) {
  reads(verb,
        verb.add_option("files",
                        a.files,
                        "Trajectories: files (also compressed), - for standard input, "
                        "bag:FILE#/topic or bag:FILE#tf:PARENT.CHILD"))
      ->required()
      ->expected(1, -1);
  declare_reading(verb, a.reading);
}

void declare_output(CLI::App& verb, TrajArguments& a) {
  const char* const help = "Output file, or folder for several; - is standard output";
  writes(verb, add(verb, "-o,--out PATH", a.out, help), FileKind::trajectory);
  add(verb,
      "--to WORD:" + fmt::format("{}", fmt::join(written_formats(), "|")),
      a.to,
      "Output format (default: by the ending of -o, or tum)");
  writes(verb,
         add(verb, "--times-out FILE", a.times_out, "File for the stamps of KITTI poses"),
         FileKind::stamps);
}

void declare_offset(CLI::App& verb, TrajArguments& a) {
  verb.add_option("--offset,--t_offset", a.offset, "Time offset added to the files' stamps [s]")
      ->check(finite_number());
}

void declare_changes(CLI::App& verb, TrajArguments& a) {
  declare_pose_filters(verb, a.downsample, a.motion_filter);
  declare_offset(verb, a);
  add(verb, "--project_to_plane", a.plane, "Plane to project onto");
}

void declare_pairing(CLI::App& verb, TrajArguments& a) {
  reads(verb, add(verb, "--ref FILE", a.reference, "Reference trajectory"))->required();
  verb.add_option("--association",
                  a.association,
                  "Pairing: evo (nearest stamp, a pose can be paired twice) or nearest "
                  "(one-to-one, smallest differences first)")
      ->check(CLI::IsMember({"evo", "nearest"}));
  verb.add_option(
          "--max-diff,--t_max_diff", a.max_diff, "Maximum time difference between paired poses [s]")
      ->check(finite_number());
  declare_offset(verb, a);
}

void declare_crop(CLI::App& verb, TrajArguments& a) {
  verb.add_option("--start,--t_start", a.start, "First stamp [s]")->check(finite_number());
  verb.add_option("--end,--t_end", a.end, "Last stamp [s]")->check(finite_number());
  verb.add_flag("--relative", a.relative, "Count --start and --end from the first stamp");
}

void declare_transform(CLI::App& verb, TrajArguments& a) {
  const char* const values =
      "x,y,z [m] or x,y,z,qx,qy,qz,qw, or a JSON file with these keys and scale";
  const auto transform = [&](const char* name, std::string& value, const char* side) {
    const std::string help = std::string("Transform to multiply on the ") + side + ": " + values;
    return reads(verb, verb.add_option(name, value, help));
  };
  auto* left = transform("--left", a.left, "left");
  auto* right = transform("--right", a.right, "right");
  right->excludes(left);
  verb.add_flag("--invert", a.invert, "Use the inverse of the transform");
  verb.add_flag("--propagate", a.propagate, "Apply --right to each relative pose, as drift")
      ->needs(right);
  Conventions& c = a.conventions;
  add(verb,
      "--quaternion-order WORD:wxyz|xyzw",
      c.quaternion_order,
      "Order in which the file stores quaternions, if it was read in the other one");
  verb.add_flag("--conjugate", c.conjugate, "Invert the rotations, but not the positions");
  add(verb, "--axes AXES", c.axes, "Source axis of x, y and z of the positions: --axes=-y,x,z");
  add(verb,
      "--mirror WORD:x|y|z",
      c.mirror,
      "Axis to reverse in positions and rotations (left-handed)");
  verb.add_option("--scale", c.scale, "Factor of the positions: 0.001 for millimetres")
      ->check(finite_number());
  verb.add_option("--stamp-scale", c.stamp_scale, "Factor of the stamps: 0.001 for milliseconds")
      ->check(finite_number());
  verb.add_flag(
      "--invert-poses", c.invert_poses, "Invert each pose: body_from_world to world_from_body");
  verb.add_flag("--chain", c.chain, "Compose rows that are motions from one row to the next");
}

void declare_parts(CLI::App& verb, TrajArguments& a) {
  reads(
      verb,
      add(verb, "--ref FILE", a.reference, "Reference trajectory, which shows where parts begin"));
  reads(verb,
        add(verb,
            "--parts FILE",
            a.parts,
            "auto (with --ref), or a file with the first, or first and last, stamp of each part"));
}

void declare_alignment(CLI::App& verb, TrajArguments& a) {
  add(verb, "--align", a.align, "Alignment");
  verb.add_option("--align-first,--n_to_align", a.align_first, "Number of first pairs, 0 for all");
  verb.add_flag(
      "--json", a.json, "Print the transforms as JSON, as eval does, and poses only to -o FILE");
}

struct VerbInfo {
  const char* name;
  const char* help;
  std::vector<void (*)(CLI::App&, TrajArguments&)> options;
};

const std::vector<VerbInfo>& verb_infos() {
  static const std::vector<VerbInfo> all{
      {"info",
       "Print number of poses, duration, distance, speed, rate, gaps and bounding box",
       {[](CLI::App& verb, TrajArguments& a) { verb.add_flag("--json", a.json, "Print JSON"); }}},
      {"convert",
       "Convert to another format without loss; also keep fewer poses, shift stamps, or project",
       {declare_changes, declare_output}},
      {"merge",
       "Merge files into one trajectory, sorted by stamp; of equal stamps the first pose is kept, "
       "or see --repeats",
       {declare_output}},
      {"crop", "Keep the poses in a time range", {declare_crop, declare_output}},
      {"split",
       "Write the parts that have a frame of their own, as eval --parts finds them",
       {declare_parts, declare_offset, declare_output}},
      {"transform",
       "Multiply all poses by a transform, or change their conventions",
       {declare_transform, declare_output}},
      {"align", "Align to a reference", {declare_pairing, declare_alignment, declare_output}},
      {"plot",
       "Plot trajectories: their plane, space, position, orientation and speed over time",
       {[](CLI::App& verb, TrajArguments& a) {
         reads(verb, add(verb, "--ref FILE", a.reference, "Reference trajectory"));
         const char* const help = "Output file: .svg, .pdf, .png or .pgf";
         writes(verb, verb.add_option("-o,--out", a.out, help)->required(), FileKind::figure);
         add(verb,
             "--panels WORDS",
             a.panels,
             "Comma-separated panels: the plane of the largest extent (plane), xy, xz, yz, space "
             "(xyz), x, y, z, roll, pitch, yaw, speed; default: all but xy, xz and yz")
             ->delimiter(',')
             ->check(CLI::IsMember(split_list("plane,xy,xz,yz,xyz,x,y,z,roll,pitch,yaw,speed")));
         declare_figures(verb, a.figures);
       }}}};
  return all;
}

}  // namespace

std::vector<std::string> written_formats() {
  std::vector<std::string> out;
  for (const auto& [name, format] : choices(Format{})) {
    if (can_write(format)) out.emplace_back(name);
  }
  return out;
}

Format written_format(const std::string& out, const std::string& to) {
  static const std::map<std::string, Format> kEndings{{"", Format::tum},
                                                      {".txt", Format::tum},
                                                      {".tum", Format::tum},
                                                      {".csv", Format::csv},
                                                      {".g2o", Format::g2o},
                                                      {".kitti", Format::kitti}};
  if (to.empty()) {
    const bool is_folder = std::filesystem::is_directory(out);
    const std::string ending = is_folder ? "" : std::filesystem::path(out).extension().string();
    const auto found = kEndings.find(ending);
    if (found != kEndings.end()) return found->second;
    throw InputError(
        out +
        ": expected a file name that ends in .txt, .tum, .csv, .g2o or .kitti, or --to FORMAT");
  }
  const std::vector<std::string> known = written_formats();
  if (std::ranges::count(known, to) > 0) return from_text<Format>(to).value();
  throw OptionError(
      "to", fmt::format("to = {}: expected one of {}", to, fmt::join(known, " | ")), {to, known});
}

void declare_traj(CLI::App& traj, const std::map<std::string, TrajVerb>& verbs, int& exit_code) {
  for (const VerbInfo& info : verb_infos()) {
    auto arguments = std::make_shared<TrajArguments>();
    CLI::App* verb = traj.add_subcommand(info.name, info.help);
    declare_inputs(*verb, *arguments);
    for (const auto& declare : info.options) declare(*verb, *arguments);
    verb->callback(
        [arguments, run = verbs.at(info.name), &exit_code] { exit_code = run(*arguments); });
  }
}

}  // namespace loopbench::harness
