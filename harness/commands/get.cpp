#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/base/suggest.hpp"
#include "harness/base/wrap.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/download.hpp"
#include "harness/commands/standard_output.hpp"

namespace loopbench::harness {
namespace {

struct GetArguments {
  std::vector<std::string> names;
  std::string data = ".";
};

void print_catalogue(const std::vector<PublicFile>& known) {
  const std::size_t columns = standard_output_style().width;
  const auto print = [&](const std::string& name, const std::string& what) {
    fmt::print(
        "{}",
        columns == 0 ? fmt::format("{:<20} {}\n", name, what) : beside(name, what, 22, columns));
  };
  for (const PublicFile& each : known) {
    print(each.name, fmt::format("{} [{}]", each.summary, each.licence));
  }
  for (const PublicPage& each : public_pages()) print(each.name, "by hand: " + each.url);
}

/// Throws InputError if the dataset has to be downloaded by hand.
void require_downloadable(const std::string& name) {
  for (const PublicPage& each : public_pages()) {
    if (each.name != name) continue;
    throw InputError(
        fmt::format("{}: has to be downloaded by hand from {}; its {} is read as it is",
                    name,
                    each.url,
                    each.file));
  }
}

int get(const GetArguments& arguments) {
  const std::vector<PublicFile> known = public_files();
  if (arguments.names.empty()) {
    print_catalogue(known);
    return kExitOk;
  }
  std::vector<std::string> names;
  for (const PublicFile& each : known) names.push_back(each.name);
  for (const std::string& name : arguments.names) {
    require_downloadable(name);
    if (std::ranges::count(names, name) == 0) {
      throw InputError(unknown_name("sequence", name, names));
    }
  }
  for (const std::string& name : arguments.names) {
    const PublicFile& wanted = *std::ranges::find(known, name, &PublicFile::name);
    fmt::print("{}: {}, licence: {}\n", name, wanted.url, wanted.licence);
    std::fflush(stdout);
    const bool was_there = fetch(wanted, arguments.data) == Fetched::present;
    const std::string file = (std::filesystem::path(arguments.data) / wanted.file).string();
    fmt::print("{}: {}, SHA-256 verified\n", file, was_there ? "is there" : "downloaded");
  }
  return kExitOk;
}

}  // namespace

void add_get(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<GetArguments>();
  CLI::App* command =
      app.add_subcommand("get", "Download public sequences and verify them by their SHA-256");
  command->add_option("names", arguments->names, "Names of sequences; none: print the catalogue");
  command->add_option("--data", arguments->data, "Folder to write to")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR")
      ->capture_default_str();
  command->footer("Interrupted downloads continue, and content with another hash is rejected.");
  command->callback([arguments, &exit_code] { exit_code = get(*arguments); });
}

}  // namespace loopbench::harness
