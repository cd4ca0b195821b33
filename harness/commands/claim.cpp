#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/base/pattern.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/looks.hpp"
#include "harness/commands/run.hpp"
#include "harness/config/read_claim.hpp"
#include "harness/tables/claim_store.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

struct ClaimArguments {
  std::vector<std::string> files;
  std::string data;
  std::string out;
  int jobs = RunArguments{}.jobs;
};

constexpr std::size_t kLongestClaim = 1'000'000;  // [bytes]

/// The config beside the claim, or an installed one.
std::string config_to_run(const Claim& claim) {
  const fs::path beside = claim.file.parent_path() / claim.config;
  std::error_code error;
  return fs::is_regular_file(beside, error) ? beside.string() : config_path(claim.config);
}

/// Runs the two methods of the claim, answers it, and records the look unless its results are those
/// of an earlier one.
int answer(const fs::path& file, const ClaimArguments& arguments, const Source& source) {
  const std::string text = read_named_file(file, kLongestClaim, "claim");
  const Claim claim = parse_claim(text, file);
  RunArguments run;
  run.config = config_to_run(claim);
  run.only = " / (?:" + pattern_of_any({claim.method, claim.baseline}).substr(4);
  run.data = arguments.data;
  run.out =
      arguments.out.empty() ? "results/" + fs::path(run.config).stem().string() : arguments.out;
  run.jobs = arguments.jobs;
  run.quiet = true;
  const int ran = run_config(run, source);
  if (ran == kExitInterrupted) return ran;
  require_same_sequences(claim, sequences_of(claim, run.out));
  Look look = look_at_store(claim, run.out);
  look.date = today();
  look.commit = commit_of(source);
  const auto seen = std::ranges::find_if(
      claim.looks, [&](const Look& earlier) { return has_same_results(earlier, look); });
  const bool is_new = seen == claim.looks.end();
  const std::size_t number = static_cast<std::size_t>(seen - claim.looks.begin()) + 1;
  if (!is_new) {
    look = *seen;
    look.answer = answer_of(claim, look);
  }
  fmt::print(
      "{}: {}\n  {}\n  {}\n",
      to_text(look.answer),
      printable(claim.statement.empty() ? file.string() : claim.statement),
      printable(text_of(claim, look)),
      is_new ? fmt::format("look {} at level {:.4g}, recorded", number, look.level)
             : fmt::format(
                   "the results of look {} on {}: no look is spent", number, printable(look.date)));
  if (is_new) write_file(file, with_look(text, file, look));
  if (look.answer == claim.expected) return kExitOk;
  fmt::print("  expected: {}\n", to_text(claim.expected));
  return kExitUnexpected;
}

}  // namespace

void add_claim(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<ClaimArguments>();
  CLI::App* command = app.add_subcommand(
      "claim", "Check claims again: run their two methods, compare them, and record the look");
  command->add_option("claims", arguments->files, "Claim files (YAML), see `compare --as-claim`")
      ->required();
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "Folder of results (default: results/CONFIG)")
      ->type_name("DIR");
  command->add_option("-j,--jobs", arguments->jobs, "Number of workers; does not affect results")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->callback([arguments, source, &exit_code] {
    exit_code = kExitOk;
    for (const std::string& file : arguments->files) {
      const int one = answer(file, *arguments, source);
      exit_code = std::max(exit_code, one);
      if (one == kExitInterrupted) break;
    }
  });
}

}  // namespace loopbench::harness
