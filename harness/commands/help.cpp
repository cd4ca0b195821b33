#include "harness/commands/help.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/commands/commands.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
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
     "  loopbench list motion_drift\n"
     "  loopbench list methods 'dm*'\n"},
    {"table",
     "  loopbench table results/quickstart\n"
     "  loopbench table results/quickstart --rows sequence --show gain\n"
     "  loopbench table results/quickstart --split '' --plus-minus --format latex -o table.tex\n"},
    {"compare",
     "  loopbench compare results/quickstart\n"
     "  loopbench compare results/quickstart --metric 'error x' --where times=dense\n"
     "  loopbench compare results/quickstart --over sequences --format csv -o compared.csv\n"},
    {"check",
     "  loopbench check results/quickstart --baseline results/reference/quickstart.json\n"
     "  loopbench check results/mine --baseline mine.json --update\n"
     "  loopbench check results/mine --baseline mine.json --junit junit.xml\n"},
    {"eval",
     "  loopbench eval reference.txt estimate.txt\n"
     "  loopbench eval reference.txt estimate.txt --align sim3 --json\n"
     "  loopbench eval reference.txt a.txt b.txt --protocol evo,tum,rpg\n"},
    {"get",
     "  loopbench get\n"
     "  loopbench get tum_fr1_room --data /data\n"
     "  loopbench get kitti_poses parking_garage --data /data\n"},
    {"help",
     "  loopbench help\n"
     "  loopbench help run\n"
     "  loopbench run --help\n"},
    {"reproduce",
     "  loopbench reproduce configs/paper_tables_fr1.yaml --data /data\n"
     "  loopbench reproduce configs/paper_tables_*.yaml --data /data\n"
     "  loopbench reproduce configs/paper_tables_fr1.yaml --data /data --out reproduced\n"},
    {"calibrate",
     "  loopbench calibrate mine.yaml --train 'my run' --out learnt.yaml\n"
     "  loopbench calibrate configs/kitti_chains.yaml --train 'viso2 KITTI 0[67]' --data /data "
     "--out "
     "learnt.yaml\n"
     "  loopbench calibrate mine.yaml --draws 500 --out learnt.yaml\n"},
    {"merge",
     "  loopbench merge results/a results/b -o results/all\n"
     "  loopbench table results/all\n"
     "  loopbench compare results/all\n"},
    {"submit",
     "  loopbench submit mine.yaml --array 16 --time 2:00:00 --memory 16GiB --dry-run\n"
     "  loopbench submit mine.yaml --array 16 --time 2:00:00 --memory 16GiB --partition long\n"
     "  loopbench submit mine.yaml --engine local --array 2\n"},
    {"watch",
     "  loopbench watch results/mine\n"
     "  loopbench watch results/mine --every 60\n"
     "  loopbench watch results/mine --once\n"},
    {"cancel",
     "  loopbench cancel results/mine\n"
     "  loopbench watch results/mine --once\n"
     "  loopbench submit mine.yaml\n"},
    {"salvage",
     "  loopbench salvage results/damaged -o results/saved\n"
     "  loopbench table results/saved\n"
     "  loopbench run mine.yaml --out results/saved\n"},
    {"correct",
     "  loopbench correct graph.g2o --method pose_graph -o corrected.g2o\n"
     "  loopbench correct run.txt --loops loops.txt --method motion_drift -o corrected.txt\n"
     "  loopbench correct graph.g2o --method uniform:weights=distance -o corrected.txt --json\n"},
    {"export",
     "  loopbench run configs/quickstart.yaml --save-trajectories\n"
     "  loopbench export results/quickstart --what trajectories -o estimates\n"
     "  loopbench export results/quickstart --what rows -o rows.csv\n"},
    {"traj",
     "  loopbench traj info *.txt\n"
     "  loopbench traj convert run.bag --all-topics --to tum -o out/\n"
     "  loopbench traj align estimate.txt --ref reference.txt --align sim3 -o aligned.txt\n"},
    {"doctor",
     "  loopbench doctor reference.txt estimate.txt\n"
     "  loopbench doctor reference.txt estimate.txt --apply corrected/\n"
     "  loopbench doctor graph.g2o\n"},
    {"plot",
     "  loopbench plot results/quickstart -o figures\n"
     "  loopbench plot results/quickstart -o figures --methods raw,dual\n"
     "  loopbench report results/quickstart -o report.html\n"},
    {"profile",
     "  loopbench profile results/quickstart\n"
     "  loopbench profile results/quickstart --only 'driving'\n"
     "  loopbench profile results/quickstart --format csv -o costs.csv\n"},
    {"report",
     "  loopbench report results/quickstart -o report.html\n"
     "  loopbench report results/quickstart/results.sqlite -o - >report.html\n"
     "  loopbench report results/quickstart -o report.html --size 2\n"},
    {"verify",
     "  loopbench verify configs/quickstart.yaml\n"
     "  loopbench verify mine.yaml --data /data\n"
     "  loopbench verify mine.yaml --only 'my run / raw'\n"},
};

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  command->add_option("command", *name, "name of a command");
  command->callback([&app, name, &exit_code] {
    exit_code = kExitOk;
    if (name->empty()) {
      // app.help() would print the help of the parsed subcommand.
      const auto formatter = app.get_formatter();
      fmt::print("{}", formatter->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
      return;
    }
    std::vector<std::string> known;
    for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
      if (each->get_name() == *name) {
        fmt::print("{}", each->help(app.get_name()));
        return;
      }
      if (!each->get_group().empty()) known.push_back(each->get_name());
    }
    throw InputError(unknown_name("command", *name, known));
  });
}

void add_examples(CLI::App& app) {
  const auto add = [](CLI::App& command, const std::string& name) {
    const auto found = kExamples.find(name);
    if (found == kExamples.end()) return;
    const std::string before = command.get_footer();
    command.footer("Examples:\n" + found->second + (before.empty() ? "" : "\n" + before));
  };
  add(app, "");
  for (CLI::App* each : app.get_subcommands([](CLI::App*) { return true; })) {
    add(*each, each->get_name());
  }
}

}  // namespace loopbench::harness
