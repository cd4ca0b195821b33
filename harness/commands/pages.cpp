#include <CLI/CLI.hpp>

#include "harness/commands/command_texts.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/help.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {

void add_pages(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("pages", "Write shell completions");
  command->group("");  // only for the build
  command->add_option("folder", *folder, "Output folder")->required();
  command->callback([&app, folder, &exit_code] {
    const auto is_visible = [](const CLI::App* each) { return !each->get_group().empty(); };
    CommandTexts all{command_text_of(app, "")};
    for (const CLI::App* each : std::as_const(app).get_subcommands(is_visible)) {
      all.push_back(command_text_of(*each, each->get_name()));
      for (const CLI::App* verb : each->get_subcommands(is_visible)) {
        all.push_back(command_text_of(*verb, each->get_name() + " " + verb->get_name()));
      }
    }
    for (const auto& [name, text] : command_pages(all)) {
      write_file(std::filesystem::path(*folder) / name, text);
    }
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
