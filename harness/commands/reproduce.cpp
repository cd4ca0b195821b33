#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/article/claims.hpp"
#include "harness/article/paper_figures.hpp"
#include "harness/article/paper_tables.hpp"
#include "harness/article/segment_claims.hpp"
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

std::vector<std::string> readings(const std::vector<PaperCell>& cells) {
  std::vector<std::string> out;
  for (const PaperCell& cell : cells) {
    if (!cell.reading.empty() && std::ranges::count(out, cell.reading) == 0) {
      out.push_back(cell.reading);
    }
  }
  return out;
}

bool is_oracle(const std::vector<PaperCell>& cells, const std::string& reading) {
  return std::ranges::any_of(cells, [&](const PaperCell& cell) {
    return cell.reading == reading && cell.result.oracle_method;
  });
}

int reproduce(const ReproduceArguments& arguments) {
  const Catalogue known = catalogue({});
  std::vector<PaperCell> done;
  for (const std::string& config : arguments.configs) {
    const Sweep sweep = read_sweep(config, known, arguments.data);
    Progress progress(cells(sweep, seeded(sweep, known), "").size());
    const auto finished = [&](const PaperCell& c) {
      progress.step(fmt::format("{} {} {} {}", c.sequence, c.input, c.reading, c.variant));
    };
    for (PaperCell& cell : run_paper(sweep, known, data_root(sweep, arguments.data), finished)) {
      done.push_back(std::move(cell));
    }
  }
  reject_standard_output("--out", arguments.out);
  const std::filesystem::path out(arguments.out);
  std::string claims;
  for (const std::string& reading : readings(done)) {
    const bool leaks = is_oracle(done, reading);
    claims += fmt::format("\n## Claims, reading `{}`{}\n\n",
                          reading,
                          leaks ? " (oracle: uses the reference)" : "") +
              claim_table(check_claims(done, reading));
    if (leaks) continue;  // nothing to show: part of the curve is the reference itself
    for (const std::string& name : paper_figures(done, reading, out / reading)) {
      fmt::print("{}\n", (out / reading / name).string());
    }
  }
  const std::vector<Claim> segments = check_segment_claims(done);
  if (!segments.empty()) claims += "\n## Claims on segments\n\n" + claim_table(segments);
  write_result(out / "tables.md", "# Tables 1 to 4\n" + paper_tables(done));
  write_result(out / "claims.md", "# The article's claims\n" + claims);
  fmt::print("{}\n{}\n", (out / "tables.md").string(), (out / "claims.md").string());
  return kExitOk;
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command =
      app.add_subcommand("reproduce", "Reproduce tables, claims and figures of the article");
  command->add_option("configs", arguments->configs, "Configs, configs/paper_tables_*.yaml")
      ->required();
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "Output folder for tables, claims and figures")
      ->type_name("DIR")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = reproduce(*arguments); });
}

}  // namespace loopbench::harness
