#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); });
}

namespace {

/// Three examples per command; "" is the program.
const std::map<std::string, std::string> kExamples{
    {"",
     "  loopbench run configs/quickstart.yaml\n"
     "  loopbench eval reference.txt estimate.txt --align sim3\n"
     "  loopbench help table\n"},
    {"run",
     "  loopbench run configs/quickstart.yaml\n"
     "  loopbench run mine.yaml --dry-run\n"
     "  loopbench run mine.yaml --only 'my run / (raw|dual)' --data /data --jobs 4\n"},
    {"list",
     "  loopbench list\n"
     "  loopbench list dual\n"
     "  loopbench list methods 'dm*'\n"},
    {"table",
     "  loopbench table results/quickstart\n"
     "  loopbench table results/quickstart --split '' --plus-minus --format latex -o table.tex\n"
     "  loopbench table results/quickstart --success 0.1 --value p95\n"},
    {"compare",
     "  loopbench compare results/quickstart\n"
     "  loopbench compare results/quickstart --where times=dense,unit=m --assert 'dual is below "
     "raw'\n"
     "  loopbench compare results/quickstart --over sequences --format csv -o compared.csv\n"},
    {"check",
     "  loopbench check results/quickstart --baseline results/reference/quickstart.json\n"
     "  loopbench check results/mine --baseline mine.json --update\n"
     "  loopbench check results/mine --baseline mine.json --junit junit.xml\n"},
    {"eval",
     "  loopbench eval reference.txt estimate.txt --align sim3\n"
     "  loopbench eval reference.txt a.txt b.txt --protocol evo,tum,rpg\n"
     "  loopbench eval reference.txt slam_1.txt slam_2.txt --store results/slam\n"},
    {"merge",
     "  loopbench merge results/a results/b -o results/all\n"
     "  loopbench table results/all\n"
     "  loopbench compare results/all\n"},
    {"submit",
     "  loopbench submit mine.yaml --array 16 --print\n"
     "  loopbench submit mine.yaml --array 16 --header slurm.sh\n"
     "  loopbench submit mine.yaml --array 4 -- --retry failed --only room\n"},
    {"correct",
     "  loopbench correct graph.g2o -o corrected.g2o --plot corrected.svg\n"
     "  loopbench correct run.txt --loops loops.txt --method dual_pcm -o corrected.txt\n"
     "  loopbench correct run.txt --loops loops.txt --break 131.5 -o corrected.txt\n"},
    {"loops",
     "  loopbench loops graph.g2o\n"
     "  loopbench loops run.txt --loops loops.txt --csv ledger.csv --plot loops.svg\n"
     "  loopbench loops graph.g2o -o repaired.g2o --report loops.html\n"},
    {"export",
     "  loopbench run configs/quickstart.yaml --save-trajectories\n"
     "  loopbench export results/quickstart --what trajectories -o estimates\n"
     "  loopbench export results/quickstart -o rows.csv\n"},
    {"traj",
     "  loopbench traj info *.txt\n"
     "  loopbench traj convert run.bag --all-topics --to tum -o out/\n"
     "  loopbench traj align estimate.txt --ref reference.txt --align sim3 -o aligned.txt\n"},
    {"traj info",
     "  loopbench traj info *.txt\n"
     "  loopbench traj info run.mcap --all-topics\n"
     "  loopbench traj info bag:run.bag#tf:map.base_link --json\n"},
    {"traj convert",
     "  loopbench traj convert poses.txt --times times.txt --to tum -o poses.tum\n"
     "  loopbench traj convert run.bag --all-topics --to tum -o out/\n"
     "  loopbench traj convert data.csv --to kitti --times-out times.txt -o poses.txt\n"
     "  loopbench traj convert run.txt --downsample 500 --project_to_plane xy -o fewer.txt\n"},
    {"traj merge",
     "  loopbench traj merge part1.txt part2.txt -o all.txt\n"
     "  loopbench traj merge part*.txt -o - | loopbench traj info -\n"
     "  loopbench traj merge a.txt b.txt --repeats keep_first -o all.txt\n"},
    {"traj crop",
     "  loopbench traj crop run.txt --start 10 --end 60 --relative -o middle.txt\n"
     "  loopbench traj crop *.txt --start 1403715273.26 -o cropped/\n"
     "  zcat run.txt.gz | loopbench traj crop - --end 60 --relative -o start.txt\n"},
    {"traj transform",
     "  loopbench traj transform run.txt --left 1,2,0,0,0,0.707,0.707 -o moved.txt\n"
     "  loopbench traj transform imu.txt --right imu_from_camera.json -o camera.txt\n"
     "  loopbench traj transform run.txt --quaternion-order wxyz --scale 0.001 -o metres.txt\n"},
    {"traj align",
     "  loopbench traj align estimate.txt --ref reference.txt -o aligned.txt\n"
     "  loopbench traj align mono.txt --ref reference.txt --align sim3 -o aligned.txt\n"
     "  loopbench traj align estimate.txt --ref reference.txt --json\n"},
    {"traj plot",
     "  loopbench traj plot run.txt -o run.pdf\n"
     "  loopbench traj plot a.txt b.txt --ref reference.txt -o compared.svg\n"
     "  loopbench traj plot a.txt b.txt --panels plane --size 3.3,2.8 --labels A,B -o map.pgf\n"
     "  loopbench traj plot run.bag --all-topics -o run.png\n"},
    {"doctor",
     "  loopbench doctor reference.txt estimate.txt\n"
     "  loopbench doctor estimate.txt --loops loops.txt\n"
     "  loopbench doctor graph.g2o\n"},
    {"plot",
     "  loopbench plot results/quickstart -o figures\n"
     "  loopbench plot results/quickstart -o figures --methods raw,dual --sequences room\n"
     "  loopbench plot results/quickstart --panels ratio,time,boxes --size 3.3,2.4 --format pgf\n"},
    {"report",
     "  loopbench report results/quickstart -o report.html\n"
     "  loopbench report results/quickstart -o report.html --size 2\n"
     "  loopbench report results/quickstart -o - | gzip >report.html.gz\n"},
};

/// Exit codes of a command besides 0, 2 and 3.
struct ExitCodes {
  std::string one = {};   ///< what 1 means; empty: the command does not exit with 1
  std::string more = {};  ///< those above 3
};
/// "" is the program.
const std::map<std::string, ExitCodes> kExitCodes{
    {"",
     {"failed cells, regressions or assertions",
      "; 4 the build lacks a required part; 130 interrupted"}},
    {"run", {"failed cells", "; 4 the build lacks a required part; 130 interrupted"}},
    {"eval", {"an estimate failed or covers too little"}},
    {"compare", {"an assertion is not shown"}},
    {"check", {"regressions"}},
    {"loops", {"closures, anchors or odometry contradict each other"}},
    {"doctor", {"mistakes found or nothing could be checked"}},
};

std::string exit_codes_text(const std::string& command) {
  const auto found = kExitCodes.find(command);
  const ExitCodes codes = found == kExitCodes.end() ? ExitCodes{} : found->second;
  return "Exit codes: 0 success; " + (codes.one.empty() ? "" : "1 " + codes.one + "; ") +
         "2 invalid input or output; 3 internal error" + codes.more;
}

const CLI::App* named_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* each : commands_of(app)) {
    if (each->get_name() == name) return each;
    known.push_back(each->get_name());
  }
  throw InputError(unknown_name("command", name, known));
}

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  command->add_option("command", *names, "name of a command: run, traj, traj crop");
  command->callback([&app, names, &exit_code] {
    exit_code = kExitOk;
    if (names->empty()) {
      // app.help() would print the help of the parsed subcommand.
      const auto formatter = app.get_formatter();
      fmt::print("{}", formatter->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
      return;
    }
    const CLI::App* found = &app;
    std::string title = app.get_name();
    for (const std::string& name : *names) {
      found = named_command(*found, name);
      title += " " + name;
    }
    // App::help() would print the help of the parsed subcommand.
    fmt::print("{}", found->get_formatter()->make_help(found, title, CLI::AppFormatMode::Normal));
  });
}

void add_footers(CLI::App& app) {
  const auto add = [](CLI::App& command, const std::string& name) {
    const auto examples = kExamples.find(name);
    std::string footer = examples == kExamples.end() ? "" : "Examples:\n" + examples->second + "\n";
    if (!command.get_footer().empty()) footer += command.get_footer() + "\n\n";
    command.footer(footer + exit_codes_text(name));
  };
  add(app, "");
  const auto all = [](const CLI::App*) { return true; };
  for (CLI::App* each : app.get_subcommands(all)) {
    add(*each, each->get_name());
    for (CLI::App* verb : each->get_subcommands(all)) {
      add(*verb, each->get_name() + " " + verb->get_name());
    }
  }
}

}  // namespace loopbench::harness
