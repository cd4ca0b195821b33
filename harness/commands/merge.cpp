#include "harness/sweep/store/merge.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kShardsWidth = 100;

/// Lines about a mixed cluster; empty for one instruction set.
std::string mixed_text(const Merged& merged) {
  if (merged.instruction_sets.size() < 2) return "";
  std::string out = "computed on processors with different instruction sets:\n";
  for (const std::string& set : merged.instruction_sets) out += "  " + printable(set) + "\n";
  return out + "the last digits of scores can depend on them\n";
}

/// Lines about the cells that no store has; empty if none is known to be missing.
std::string missing_text(const Merged& merged) {
  if (merged.missing == 0) return "";
  std::string shards;
  for (const std::string& shard : merged.missing_shards) {
    if (shards.size() > kShardsWidth) {
      shards += ", ...";
      break;
    }
    shards += (shards.empty() ? "; shards without a cell: " : ", ") + shard;
  }
  return fmt::format("{} of {} cells are missing{}\n", merged.missing, merged.planned, shards);
}

}  // namespace

void add_merge(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::vector<std::filesystem::path> stores;
    std::filesystem::path out;
    MergeOptions options;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("merge", "Merge several stores of results into one");
  add(*command, "stores", arguments->stores, "Folders of results, or their results.sqlite")
      ->required()
      ->expected(1, -1);
  add(*command, "-o,--out", arguments->out, "Store to create, or a folder for it")->required();
  command->add_flag(
      "--mixed-builds", arguments->options.mixed_builds, "Accept cells of different builds");
  command->add_flag("--add",
                    arguments->options.add,
                    "Keep the cells of an existing output store, instead of rejecting it");
  command->footer("`loopbench run CONFIG --out OUT` computes the missing cells.");
  command->callback([arguments, &exit_code] {
    reject_standard_output("-o", arguments->out);
    std::filesystem::path out = arguments->out;
    if (out.extension() != ".sqlite") out /= "results.sqlite";
    const Merged merged = merge_stores(arguments->stores, out, arguments->options);
    fmt::print("{}{} in {}\n{}{}",
               counted(merged.cells, "cell"),
               merged.duplicates == 0 ? "" : " (" + counted(merged.duplicates, "duplicate") + ")",
               out.string(),
               missing_text(merged),
               mixed_text(merged));
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
