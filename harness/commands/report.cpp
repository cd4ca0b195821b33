#include "harness/report/report.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <thread>
#include <utility>

#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {
namespace {

/// Returns what was written, as a line.
std::string write_report(const std::string& store,
                         const std::string& out,
                         double megabytes,
                         int refresh) {
  const auto bytes = static_cast<std::size_t>(1e6 * megabytes);
  ReportContent content = read_report_content(store, bytes);
  content.refresh = refresh;
  const std::string html = report_html(std::move(content), bytes);
  write_file(out, html);
  return fmt::format("{}: {:.2f} MB\n", printable(out), 1e-6 * static_cast<double>(html.size()));
}

/// Waits until `run` has created the store. Returns at once if something else has the name.
void wait_for_store(const std::filesystem::path& store, std::chrono::seconds between) {
  const auto is_missing = [&] {
    const bool is_folder = std::filesystem::is_directory(store);
    const std::filesystem::path file = is_folder ? store / "results.sqlite" : store;
    return !std::filesystem::exists(file) || (std::filesystem::is_regular_file(file) &&
                                              has_no_tables(file) && is_being_written(store));
  };
  if (is_missing()) print_error("{}: waiting for `run` to create it\n", printable(store.string()));
  while (is_missing()) std::this_thread::sleep_for(between);
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string store;
    std::string out = "report.html";
    double megabytes = 9.0;
    int every = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("report", "Write the results of a sweep as one HTML file");
  command->add_option("store", arguments->store, "Folder of results, or its results.sqlite")
      ->required();
  command->add_option("-o,--out", arguments->out, "File to write; - is standard output")
      ->type_name("FILE")
      ->capture_default_str();
  command
      ->add_option(
          "--size",
          arguments->megabytes,
          "Maximum file size, reached by thinning trajectories, then by leaving out sequences [MB]")
      ->check(number_between(0.1, 1000.0))
      ->capture_default_str();
  command
      ->add_option(
          "--every",
          arguments->every,
          "While `run` writes to the store, write the report again every N seconds; a page "
          "that is open in a browser reloads itself")
      ->type_name("N")
      ->check(number_between(1.0, 3600.0));
  command->callback([arguments, &exit_code] {
    if (arguments->every > 0 && is_dash(arguments->out)) {
      throw InputError("--every: needs a file to write again and again, found --out -");
    }
    const std::chrono::seconds between(arguments->every);
    if (arguments->every > 0) wait_for_store(arguments->store, between);
    reject_overwriting({store_file(arguments->store)}, arguments->out);
    while (arguments->every > 0 && is_being_written(arguments->store)) {
      write_report(arguments->store, arguments->out, arguments->megabytes, arguments->every);
      std::this_thread::sleep_for(between);
    }
    const std::string written =
        write_report(arguments->store, arguments->out, arguments->megabytes, 0);
    if (is_dash(arguments->out)) {
      print_error("{}", written);
    } else {
      fmt::print("{}", written);
    }
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
