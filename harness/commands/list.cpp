#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "datasets/core/renamed.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/commands/commands.hpp"
#include "harness/text/suggest.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kSubjects{"datasets", "methods", "metrics", "protocols"};

struct ListArguments {
  std::string subject;
  std::vector<std::filesystem::path> plugins;
  bool json = false;
};

struct Item {
  std::string name;
  std::string kind;  ///< corrector, smoother, joint; a protocol's version; otherwise empty
  std::string summary;
  std::vector<OptionInfo> options;
  bool is_oracle = false;  ///< a method with access to the reference
};

std::vector<Item> items(const Catalogue& known, const std::string& subject) {
  std::vector<Item> out;
  if (subject == "datasets") {
    for (const auto& e : known.datasets) out.push_back({e.name, "", e.summary, e.options, false});
  } else if (subject == "methods") {
    for (const auto& e : known.methods) {
      const bool is_oracle = find_oracle(known, e.name) != nullptr;
      out.push_back({e.name, to_text(e.kind), e.summary, e.options, is_oracle});
    }
  } else if (subject == "metrics") {
    for (const auto& e : known.metrics) out.push_back({e.name, "", e.summary, e.options, false});
  } else {
    for (const auto& e : metrics::protocols()) {
      out.push_back({e.name, e.version, e.summary, describe(e.protocol), false});
    }
  }
  return out;
}

Json to_json(const Param& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

Json to_json(const Item& item, bool is_protocol) {
  Json options = Json::array();
  for (const OptionInfo& o : item.options) {
    options.push_back(
        {{"name", o.name}, {"default", to_json(o.value)}, {"rule", o.rule}, {"help", o.help}});
  }
  Json out{{"name", item.name}};
  if (!item.kind.empty()) out[is_protocol ? "version" : "kind"] = item.kind;
  if (item.is_oracle) out["oracle"] = true;
  out["summary"] = item.summary;
  out["options"] = std::move(options);
  return out;
}

void print_line(const Item& item) {
  fmt::print(
      "{:<18} {}{}\n",
      item.name,
      item.kind.empty() ? "" : fmt::format("[{}{}] ", item.kind, item.is_oracle ? ", oracle" : ""),
      item.summary);
}

void print_options(const Item& item) {
  for (const OptionInfo& o : item.options) {
    fmt::print("    {} = {}{}  {}\n",
               o.name,
               to_text(o.value),
               o.rule.empty() ? "" : fmt::format("  ({})", o.rule),
               o.help);
  }
}

/// Protocols share their settings: one line for each protocol, then the settings.
void print(const std::string& subject, const std::vector<Item>& all) {
  const bool is_shared = subject == "protocols";
  for (const Item& item : all) {
    print_line(item);
    if (!is_shared) print_options(item);
  }
  if (!is_shared) return;
  fmt::print("settings with the defaults of {} (usage: protocol: {{base: NAME, SETTING: VALUE}})\n",
             all.front().name);
  print_options(all.front());
}

/// One line for each old name or value and the one that replaced it.
std::string renamed_names() {
  std::string out = "Renamed (old names are rejected):\n";
  for (const auto& [owner, before, now] : kRenamedNames) {
    out += fmt::format("  {}{}{} -> {}\n", owner, owner.empty() ? "metric " : ": ", before, now);
  }
  for (const auto& [option, before, now] : kRenamedValues) {
    out += fmt::format("  {0}: {1} -> {0}: {2}\n", option, before, now);
  }
  return out;
}

struct ItemList {
  std::string subject;
  std::vector<Item> items;
};

/// All lists, one of them, or the entries of that name.
std::vector<ItemList> wanted_lists(const Catalogue& known, const std::string& wanted) {
  const bool is_name = !wanted.empty() && std::ranges::count(kSubjects, wanted) == 0;
  std::vector<ItemList> out;
  std::vector<std::string> names = kSubjects;
  for (const std::string& subject : kSubjects) {
    ItemList one{subject, items(known, subject)};
    for (const Item& item : one.items) names.push_back(item.name);
    if (is_name) std::erase_if(one.items, [&](const Item& item) { return item.name != wanted; });
    if (is_name ? !one.items.empty() : wanted.empty() || wanted == subject) out.push_back(one);
  }
  if (!out.empty()) return out;
  const bool is_close = !closest(wanted, names).empty();
  throw InputError(unknown_name("list or entry", wanted, is_close ? names : kSubjects));
}

int list(const ListArguments& arguments) {
  const Catalogue known = catalogue(arguments.plugins);
  Json json;
  for (const ItemList& one : wanted_lists(known, arguments.subject)) {
    if (arguments.json) {
      json[one.subject] = Json::array();
      for (const Item& item : one.items) {
        json[one.subject].push_back(to_json(item, one.subject == "protocols"));
      }
      continue;
    }
    if (arguments.subject.empty()) fmt::print("== {} ==\n", one.subject);
    print(one.subject, one.items);
    if (arguments.subject.empty()) fmt::print("\n");
  }
  if (arguments.json) fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  return kExitOk;
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* command =
      app.add_subcommand("list", "List datasets, methods, metrics or protocols with their options");
  command->add_option("subject",
                      arguments->subject,
                      "datasets, methods, metrics, protocols, or the name of one entry");
  command->add_option("--plugin", arguments->plugins, "Shared object with additional methods")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->footer(renamed_names() + "\n" + command->get_footer());
  command->callback([arguments, &exit_code] { exit_code = list(*arguments); });
}

}  // namespace loopbench::harness
