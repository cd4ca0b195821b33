#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/commands/commands.hpp"
#include "harness/source_commit.hpp"
#include "harness/version.hpp"

using namespace loopbench;

int main(int argc, char** argv) {
  CLI::App app{"Which method corrects a trajectory best after a loop is detected?", "loopbench"};
  app.set_version_flag("--version", std::string("loopbench ") + kVersion);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 some cells failed or got worse, 2 unusable input, 3 internal error, "
      "130 interrupted.");
  int exit_code = kExitOk;
  add_run(app, exit_code, {source_commit, source_state});
  add_list(app, exit_code);
  add_table(app, exit_code);
  add_compare(app, exit_code);
  add_check(app, exit_code);
  add_eval(app, exit_code);
  add_reproduce(app, exit_code);
  add_calibrate(app, exit_code);
  add_merge(app, exit_code);
  add_plot(app, exit_code);
  add_profile(app, exit_code);
  add_report(app, exit_code);
  add_verify(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitBadInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "loopbench: {}\n", error.what());
    return kExitBadInput;
  } catch (const OptionError& error) {
    fmt::print(stderr, "loopbench: {}\n", error.what());
    return kExitBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "loopbench: internal error: {}\n", error.what());
    return kExitInternal;
  }
  return exit_code;
}
