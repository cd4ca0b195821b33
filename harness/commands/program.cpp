#include "harness/commands/program.hpp"

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
#include <ios>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/commands/output_files.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {

namespace {

std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
  }
  return out;
}

std::string with_hyphens(std::string text) {
  std::ranges::replace(text, '_', '-');
  return text;
}

/// The most similar of the options: by spelling, or those that begin with or contain the word.
std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& known) {
  const std::string core = word.substr(std::min(word.find_first_not_of('-'), word.size()));
  std::vector<std::string> cores;
  for (const std::string& each : known) cores.push_back(each.substr(2));
  if (const std::string best = closest(core, cores); !best.empty()) return {"--" + best};
  std::vector<std::string> out;
  for (const std::string& each : known) {
    const std::string its_core = each.substr(2);
    const bool is_part =
        core.size() > 2 && (with_hyphens(its_core).find(with_hyphens(core)) != std::string::npos ||
                            (its_core.size() > 3 &&
                             with_hyphens(core).find(with_hyphens(its_core)) != std::string::npos));
    if (is_part) out.push_back(each);
  }
  return out;
}

/// The word that names no subcommand or option of `command`, with a suggestion; empty if `error`
/// has another cause. `name`: of the command, empty for the program.
std::string unknown_word(const CLI::App& command,
                         const std::string& name,
                         const CLI::ParseError& error) {
  const std::vector<std::string> words = command.remaining();
  if (words.empty() || std::ranges::count(words, "--") > 0) return "";
  const bool is_unexpected = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool lacks_subcommand =
      command.get_require_subcommand_min() > 0 && command.get_subcommands().empty();
  if (!is_unexpected && !lacks_subcommand) return "";

  const std::string word = words.front().substr(0, words.front().find('='));
  const bool is_option = word.starts_with('-');
  if (!is_option && !lacks_subcommand) return "";
  std::vector<std::string> known = is_option ? long_options(command) : std::vector<std::string>{};
  if (!is_option) {
    for (const CLI::App* each : command.get_subcommands({})) {
      if (!each->get_group().empty()) known.push_back(each->get_name());  // not hidden
    }
  }
  const std::string kind = is_option ? "option" : "subcommand";
  if (is_option) known = nearest(word, known);  // --help lists all
  return unknown_name(name.empty() ? kind : kind + " of " + name, word, known);
}

/// `words` after the program's name, with hyphens and underscores in long options replaced by the
/// declared spelling: --all-pairs and --all_pairs are equivalent. O(words * options).
std::vector<std::string> normalised_options(const CLI::App& app, std::vector<std::string> words) {
  const auto is_given = [&](const CLI::App* each) {
    return !words.empty() && each->get_name() == words[0];
  };
  const std::vector<const CLI::App*> given = app.get_subcommands(is_given);
  if (given.empty()) return words;
  const std::vector<std::string> known = long_options(*given.front());
  for (std::string& word : words) {
    if (word == "--") break;  // files follow
    if (!word.starts_with("--")) continue;
    const std::size_t end = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, end);
    if (std::ranges::count(known, name) > 0) continue;
    const auto same = std::ranges::find(known, with_hyphens(name), with_hyphens);
    if (same != known.end()) word.replace(0, end, *same);
  }
  return words;
}

/// Checks the files of a command before it runs, after its line has been parsed.
class Program : public CLI::App {
 public:
  using CLI::App::App;

 private:
  void pre_callback() override {
    const CLI::App* command = this;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    check_declared_files(*command);
  }
};

/// What is wrong with the command line: the word that names no subcommand or option, with a
/// suggestion, or the command and the message of CLI11.
std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error) {
  // The first command with words left over, or the innermost one.
  const CLI::App* command = &app;
  std::string name;
  while (command->remaining().empty() && !command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += (name.empty() ? "" : " ") + command->get_name();
  }
  const std::string unknown = unknown_word(*command, name, error);
  const std::string why = (name.empty() ? "" : name + ": ") + error.what();
  return "loopbench: " + (unknown.empty() ? why : unknown) +
         "\nRun with --help for more information.\n";
}

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

/// A limit of the system on processes and threads.
std::string out_of_processes(const std::system_error& error) {
  return std::string("cannot create a process or thread: ") + error.what() +
         "; raise the limit of processes (ulimit -u)";
}

/// `print_errno` is the errno of a failed print, if known.
int run_command(CLI::App& app,
                const std::vector<std::string>& words,
                const int& exit_code,
                int& print_errno) {
  try {
    if (words.empty()) {
      fmt::print("{}", app.help());
      return kExitOk;
    }
    std::vector<std::string> last_first = normalised_options(app, words);
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
    return fail(with_guess(error), kExitBadInput);
  } catch (const MissingPart& error) {
    return fail(error.what(), kExitMissingPart);
  } catch (const std::ios_base::failure& error) {
    return fail(std::string("a file cannot be read: ") + error.what(), kExitBadInput);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.path1().string() + ": " + error.code().message(), kExitBadInput);
  } catch (const std::system_error& error) {
    // fmt throws these if standard output cannot be written.
    if (std::ferror(stdout) != 0) {
      print_errno = error.code().value();
      return kExitBadInput;
    }
    if (error.code().value() == EAGAIN) return fail(out_of_processes(error), kExitBadInput);
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), kExitInternal);
  }
  return exit_code;
}

/// Lists with commas take one word at a time: others would be files that follow.
void take_one_word(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_delimiter() != '\0') option->allow_extra_args(false);
  }
  for (CLI::App* command : app.get_subcommands({})) take_one_word(*command);
}

}  // namespace

int run_program(int argc, char** argv, const Source& source) {
  reserve_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is then an error of write()
  const std::vector<std::string> words{argv + 1, argv + argc};
  Program app{"Benchmark of loop-closure correction methods for trajectories", "loopbench"};
  app.formatter(help_formatter());
  app.set_version_flag("--version", std::string("loopbench ") + kVersion);
  app.require_subcommand(1);
  int exit_code = kExitOk;
  add_run(app, exit_code, source);
  add_list(app, exit_code);
  add_table(app, exit_code);
  add_compare(app, exit_code);
  add_check(app, exit_code);
  add_eval(app, exit_code, source);
  add_correct(app, exit_code);
  add_loops(app, exit_code);
  add_export(app, exit_code);
  add_merge(app, exit_code);
  add_submit(app, exit_code);
  add_plot(app, exit_code);
  add_report(app, exit_code);
  add_traj(app, exit_code);
  add_doctor(app, exit_code);
  add_help(app, exit_code);
  add_complete(app, exit_code);
  add_footers(app);
  take_one_word(app);
  int print_errno = 0;
  const int out = run_command(app, words, exit_code, print_errno);
  // Output counts as written only after the buffer is flushed.
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return out;
  return fail_to_print(print_errno != 0 ? print_errno : errno);
}

}  // namespace loopbench::harness
