#include "harness/store/merge.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/commands.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {

void add_merge(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::vector<std::filesystem::path> stores;
    std::filesystem::path out;
    bool mixed_builds = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("merge", "Merge several stores of results into one");
  command->add_option("stores", arguments->stores, "Folders of results, or their results.sqlite")
      ->required()
      ->expected(2, -1);
  command->add_option("-o,--out", arguments->out, "Store to create, or a folder for it")
      ->required();
  command->add_flag("--mixed-builds", arguments->mixed_builds, "Accept cells of different builds");
  command->callback([arguments, &exit_code] {
    reject_standard_output("-o", arguments->out);
    std::filesystem::path out = arguments->out;
    if (out.extension() != ".sqlite") out /= "results.sqlite";
    const Merged merged = merge_stores(arguments->stores, out, arguments->mixed_builds);
    fmt::print("{} cells{} in {}\n",
               merged.cells,
               merged.duplicates == 0 ? "" : fmt::format(" ({} duplicates)", merged.duplicates),
               out.string());
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
