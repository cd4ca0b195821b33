#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "harness/catalogue.hpp"
#include "harness/commands/commands.hpp"
#include "harness/suggest.hpp"

namespace loopbench {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kSubjects{"datasets", "methods", "metrics", "protocol"};

struct ListArguments {
  std::string subject;
  std::vector<std::filesystem::path> plugins;
  bool json = false;
};

struct Item {
  std::string name;
  std::string kind;  ///< corrector, smoother, method; empty for the rest
  std::string summary;
  std::vector<OptionInfo> options;
};

std::vector<Item> items(const Catalogue& known, const std::string& subject) {
  std::vector<Item> out;
  if (subject == "datasets") {
    for (const auto& e : known.datasets) out.push_back({e.name, "", e.summary, e.options});
  } else if (subject == "methods") {
    for (const auto& e : known.methods) {
      out.push_back({e.name, to_text(e.kind), e.summary, e.options});
    }
  } else if (subject == "metrics") {
    for (const auto& e : known.metrics) out.push_back({e.name, "", e.summary, e.options});
  } else {
    out.push_back({"protocol", "", "how estimates are paired and aligned", describe(Protocol{})});
  }
  return out;
}

Json to_json(const Param& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

Json to_json(const Item& item) {
  Json options = Json::array();
  for (const OptionInfo& o : item.options) {
    options.push_back(
        {{"name", o.name}, {"default", to_json(o.value)}, {"rule", o.rule}, {"help", o.help}});
  }
  Json out{{"name", item.name}};
  if (!item.kind.empty()) out["kind"] = item.kind;
  out["summary"] = item.summary;
  out["options"] = std::move(options);
  return out;
}

void print(const Item& item) {
  fmt::print("{:<18} {}{}\n",
             item.name,
             item.kind.empty() ? "" : fmt::format("[{}] ", item.kind),
             item.summary);
  for (const OptionInfo& o : item.options) {
    fmt::print("    {} = {}{}  {}\n",
               o.name,
               to_text(o.value),
               o.rule.empty() ? "" : fmt::format("  ({})", o.rule),
               o.help);
  }
}

int list(const ListArguments& arguments) {
  const Catalogue known = catalogue(arguments.plugins);
  if (!arguments.subject.empty() &&
      std::find(kSubjects.begin(), kSubjects.end(), arguments.subject) == kSubjects.end()) {
    throw InputError(unknown_name("list", arguments.subject, kSubjects));
  }
  Json json;
  for (const std::string& subject : kSubjects) {
    if (!arguments.subject.empty() && arguments.subject != subject) continue;
    if (arguments.json) {
      json[subject] = Json::array();
      for (const Item& item : items(known, subject)) json[subject].push_back(to_json(item));
      continue;
    }
    if (arguments.subject.empty()) fmt::print("== {} ==\n", subject);
    for (const Item& item : items(known, subject)) print(item);
    if (arguments.subject.empty()) fmt::print("\n");
  }
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return kExitOk;
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* command =
      app.add_subcommand("list", "What can be named in a config, with options and defaults");
  command->add_option("subject", arguments->subject, "datasets, methods, metrics or protocol");
  command->add_option("--plugin", arguments->plugins, "Shared object that brings methods")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "As JSON");
  command->callback([arguments, &exit_code] { exit_code = list(*arguments); });
}

}  // namespace loopbench
