#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/commands/command_line.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/defaults.hpp"
#include "harness/commands/help.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/commands/huge_pages.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/run/build.hpp"

// Source of the program; defined in files that the build links only into the executable, so that a
// commit does not relink anything else.
extern char source_commit[];  ///< 40 hexadecimal digits, or "unknown"
extern char source_state[];   ///< clean | dirty | unknown
extern char code_hash[];      ///< of the libraries whose code decides the results of cells

using namespace loopbench;
using namespace loopbench::harness;

namespace {

/// Prints each line in the width of the terminal.
void print_error_lines(const std::string& text, const std::string& prefix = "") {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    print_error("{}\n", fitted_error(printable(prefix + line)));
  }
}

/// Messages can contain names and contents of files. A config can have several errors, one per
/// line.
int fail(const std::string& why, int exit_code) {
  print_error_lines(why, "loopbench: ");
  return exit_code;
}

/// Opens /dev/null for reading in place of closed standard streams: otherwise the next file opened,
/// for example a store, would be one of them. Output then still fails.
void reserve_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) open("/dev/null", O_RDONLY);
  }
}

/// A closed pipe is no error, as with SIGPIPE.
int fail_to_print(int reason) {
  if (reason == EPIPE) return 128 + SIGPIPE;
  const std::string why = reason == 0 ? "" : std::string(": ") + std::strerror(reason);
  return fail("cannot write to standard output" + why, kExitBadInput);
}

/// `print_errno` is the errno of a failed print, if known.
int run(CLI::App& app,
        const std::vector<std::string>& words,
        const int& exit_code,
        int& print_errno) {
  try {
    if (words.empty()) {
      fmt::print("{}", app.help());
      return kExitOk;
    }
    std::vector<std::string> last_first = with_defaults(app, normalised_options(app, words));
    if (const auto text = shown_defaults(app, last_first)) {
      fmt::print("{}", printable(*text));
      return kExitOk;
    }
    std::ranges::reverse(last_first);  // CLI11 expects this order
    app.parse(std::move(last_first));
  } catch (const CLI::ParseError& error) {
    std::ostringstream parser_output;
    if (app.exit(error, parser_output, parser_output) == 0) {
      const std::string text = parser_output.str();
      if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) print_errno = errno;
      return kExitOk;
    }
    print_error_lines(parse_error_text(app, error));
    return kExitBadInput;
  } catch (const InputError& error) {
    return fail(error.what(), kExitBadInput);
  } catch (const OptionError& error) {
    return fail(error.what(), kExitBadInput);
  } catch (const MissingPart& error) {
    return fail(error.what(), kExitMissingPart);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.path1().string() + ": " + error.code().message(), kExitBadInput);
  } catch (const std::system_error& error) {
    // fmt throws these if standard output cannot be written.
    if (std::ferror(stdout) != 0) {
      print_errno = error.code().value();
      return kExitBadInput;
    }
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  }
  return exit_code;
}

}  // namespace

/// Lists with commas take one word at a time: others would be files that follow.
void take_one_word(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_delimiter() != '\0') option->allow_extra_args(false);
  }
  for (CLI::App* command : app.get_subcommands({})) take_one_word(*command);
}

// NOLINTNEXTLINE(bugprone-exception-escape): what is outside run() throws only without memory
int main(int argc, char** argv) {
  reserve_standard_streams();
  const std::vector<std::string> words{argv + 1, argv + argc};
  const auto is_first = [&](const char* command) { return !words.empty() && words[0] == command; };
  if (is_first("eval") || is_first("traj") || is_first("doctor")) use_huge_pages();
  CLI::App app{"Benchmark of loop-closure correction methods for trajectories", "loopbench"};
  app.formatter(help_formatter());
  app.set_version_flag("--version", std::string("loopbench ") + kVersion);
  app.require_subcommand(1);
  int exit_code = kExitOk;
  const Source source{source_commit, source_state, code_hash};
  add_run(app, exit_code, source);
  add_list(app, exit_code);
  add_schema(app, exit_code);
  add_table(app, exit_code);
  add_compare(app, exit_code, source);
  add_claim(app, exit_code, source);
  add_check(app, exit_code);
  add_eval(app, exit_code, source);
  add_correct(app, exit_code);
  add_export(app, exit_code);
  add_import(app, exit_code);
  add_merge(app, exit_code);
  add_submit(app, exit_code);
  add_plot(app, exit_code);
  add_report(app, exit_code);
  add_traj(app, exit_code);
  add_doctor(app, exit_code);
  add_get(app, exit_code);
  add_help(app, exit_code);
  add_complete(app, exit_code);
  add_footers(app);
  take_one_word(app);
  int print_errno = 0;
  const int out = run(app, words, exit_code, print_errno);
  // Output counts as written only after the buffer is flushed.
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return out;
  return fail_to_print(print_errno != 0 ? print_errno : errno);
}
