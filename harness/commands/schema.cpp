#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/config_schema.hpp"

namespace loopbench::harness {
namespace {

/// One line for each definition, so that changes can be read in the history of a file.
std::string text(const nlohmann::ordered_json& schema) {
  const auto dump = [](const auto& json) {
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  };
  std::string out;
  for (const auto& [key, value] : schema.items()) {
    out += (out.empty() ? "{\n" : ",\n") + dump(nlohmann::ordered_json(key)) + ": ";
    if (key != "definitions") {
      out += dump(value);
      continue;
    }
    std::string lines;
    for (const auto& [name, definition] : value.items()) {
      lines += (lines.empty() ? "{\n" : ",\n") + dump(nlohmann::ordered_json(name)) + ": " +
               dump(definition);
    }
    out += lines + "\n}";
  }
  return out + "\n}\n";
}

}  // namespace

void add_schema(CLI::App& app, int& exit_code) {
  auto plugins = std::make_shared<std::vector<std::filesystem::path>>();
  CLI::App* command =
      app.add_subcommand("schema", "Print the JSON Schema of configs, for editors and validators");
  command->add_option("--plugin", *plugins, "Shared object with methods, datasets or metrics")
      ->type_name("FILE");
  command->footer(
      "An editor with the YAML language server checks and completes a config whose first line is\n"
      "`# yaml-language-server: $schema=schema.json`, with the path of the printed file.");
  command->callback([plugins, &exit_code] {
    fmt::print("{}", text(config_schema(catalogue(*plugins))));
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
