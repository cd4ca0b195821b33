#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/article/pages.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/commands/commands.hpp"
#include "harness/config/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/execution/run/progress.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

struct ReproduceArguments {
  std::vector<std::string> configs;
  std::string data;
  std::string out = "results/paper";
};

int reproduce(const ReproduceArguments& arguments) {
  reject_standard_output("--out", arguments.out);
  const Catalogue known = catalogue({});
  std::vector<PaperConfig> done;
  for (const std::string& config : arguments.configs) {
    PaperConfig paper{read_sweep(config, known, arguments.data), {}};
    const Sweep& sweep = paper.sweep;
    Progress progress(cells(sweep, seeded(sweep, known), "").size());
    const auto finished = [&](PaperCell& c) {
      if (!needs_dense(c)) c.dense = {};
      progress.step(fmt::format("{} {} {} {}", c.sequence, c.input, c.reading, c.variant));
    };
    paper.cells = run_paper(sweep, known, data_root(sweep, arguments.data), finished);
    done.push_back(std::move(paper));
  }
  for (const std::filesystem::path& file : write_pages(done, arguments.out)) {
    fmt::print("{}\n", file.string());
  }
  return kExitOk;
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command =
      app.add_subcommand("reproduce", "Reproduce tables, statements and figures of the article");
  command->add_option("configs", arguments->configs, "Configs, configs/paper_tables_*.yaml")
      ->required();
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "Output folder for tables, ledger and figures")
      ->type_name("DIR")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = reproduce(*arguments); });
}

}  // namespace loopbench::harness
