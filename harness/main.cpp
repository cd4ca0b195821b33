#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/commands/command_line.hpp"
#include "harness/commands/commands.hpp"
#include "harness/printable.hpp"
#include "harness/source_commit.hpp"
#include "harness/version.hpp"

using namespace loopbench;

namespace {

/// Names and texts of files get into messages.
int fail(const std::string& why, int exit_code) {
  fmt::print(stderr, "{}\n", printable("loopbench: " + why));
  return exit_code;
}

/// Of a reader that has heard enough there is nothing to say, as when SIGPIPE ends us.
int fail_to_print(int reason) {
  if (reason == EPIPE) return 128 + SIGPIPE;
  const std::string why = reason == 0 ? "" : std::string(": ") + std::strerror(reason);
  return fail("cannot write to standard output" + why, kExitBadInput);
}

/// `print_error` is the errno of a failure to print, when that is known.
int run(CLI::App& app,
        const std::vector<std::string>& words,
        const int& exit_code,
        int& print_error) {
  try {
    std::vector<std::string> last_first = spelt_as_declared(app, words);
    std::ranges::reverse(last_first);  // CLI11 wants them so
    app.parse(std::move(last_first));
  } catch (const CLI::ParseError& error) {
    std::ostringstream told;
    if (app.exit(error, told, told) == 0) {
      const std::string text = told.str();
      if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) print_error = errno;
      return kExitOk;
    }
    const std::string unknown = unknown_word(app, error);
    fmt::print(stderr, "{}", printable(unknown.empty() ? told.str() : unknown));
    return kExitBadInput;
  } catch (const InputError& error) {
    return fail(error.what(), kExitBadInput);
  } catch (const OptionError& error) {
    return fail(error.what(), kExitBadInput);
  } catch (const MissingPart& error) {
    return fail(error.what(), kExitMissingPart);
  } catch (const std::system_error& error) {
    // fmt throws these when nobody takes what it prints.
    if (std::ferror(stdout) != 0) {
      print_error = error.code().value();
      return kExitBadInput;
    }
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Which method corrects a trajectory best after a loop is detected?", "loopbench"};
  app.set_version_flag("--version", std::string("loopbench ") + kVersion);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 some cells failed or got worse, 2 unusable input or output, "
      "3 internal error, 4 a part that this build was made without is needed, 130 interrupted.");
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
  int print_error = 0;
  const int out = run(app, {argv + 1, argv + argc}, exit_code, print_error);
  // What is printed is printed when it has left the buffer.
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return out;
  return fail_to_print(print_error != 0 ? print_error : errno);
}
