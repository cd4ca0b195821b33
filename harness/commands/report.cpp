#include "harness/answers/report/report.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {

void add_report(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string store;
    std::string out = "report.html";
    double megabytes = 9.0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("report", "Write the results of a sweep as one HTML file");
  declare_store(command, arguments->store);
  CLI::Option* const out =
      add(command, "-o,--out FILE", arguments->out, "File to write; - is standard output")
          ->capture_default_str();
  writes(command, out, FileKind::page);
  add(command,
      "--size",
      arguments->megabytes,
      "Maximum file size [MB]. To fit, the report omits trajectories of later repeats, then draws "
      "coarser curves, then omits later sequences from tables and figures")
      ->check(number_between(0.1, 1000.0))
      ->capture_default_str();
  command.callback([arguments, &exit_code] {
    const auto bytes = static_cast<std::size_t>(1e6 * arguments->megabytes);
    const std::string html = report_html(read_report_content(arguments->store, bytes), bytes);
    write_file(arguments->out, html);
    const std::string written = fmt::format(
        "{}: {:.2f} MB\n", printable(arguments->out), 1e-6 * static_cast<double>(html.size()));
    if (is_dash(arguments->out)) {
      print_error("{}", written);
    } else {
      fmt::print("{}", written);
    }
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
