#include <fmt/format.h>
#include <fnmatch.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/config/keys.hpp"
#include "harness/sweep/text/suggest.hpp"
#include "harness/sweep/text/wrap.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kSubjects{"datasets", "methods", "metrics", "protocols"};

/// They stay in 1.x for configs that name them, but no page recommends them: the list of everything
/// prints their names alone.
constexpr std::array<std::string_view, 9> kRarelyUsed{"rendered_room",
                                                      "uniform_position",
                                                      "uniform_open",
                                                      "two_pass_open",
                                                      "two_pass_motion",
                                                      "along_cross",
                                                      "jerk",
                                                      "interpolation_floor",
                                                      "rpg"};

struct ListArguments {
  std::string subject;
  std::string name;
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
      out.push_back({e.name, to_text(e.kind), e.summary, e.options, is_oracle(known, e.name)});
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

std::string type_of(const OptionInfo& option) {
  if (option.is_text) return "text";
  if (std::holds_alternative<bool>(option.value)) return "boolean";
  return std::holds_alternative<std::int64_t>(option.value) ? "integer" : "number";
}

void add_rule(Json& out, const OptionInfo& option) {
  if (!option.words.empty()) out["choices"] = option.words;
  const auto& [low, high, is_open] = option.range;
  if (std::isfinite(low)) out[is_open ? "exclusive_minimum" : "minimum"] = low;
  if (std::isfinite(high)) out["maximum"] = high;
}

Json to_json(const OptionInfo& option) {
  Json out{{"name", option.name}, {"type", type_of(option)}, {"default", to_json(option.value)}};
  if (option.is_optional) out["none"] = true;
  const std::string unit = unit_in(option.help);
  if (!unit.empty()) out["unit"] = unit;
  add_rule(out, option);
  out["description"] = option.help;
  return out;
}

/// Keys of a config and of its maps.
Json config_json() {
  Json out;
  for (const std::string map : {"", "limits", "timing", "table", "exclude"}) {
    Json keys = Json::array();
    for (const ConfigKey& key : config_keys(map)) {
      keys.push_back({{"name", key.name}, {"description", key.help}});
    }
    out[map.empty() ? "config" : map] = std::move(keys);
  }
  return out;
}

Json to_json(const Item& item, bool is_protocol) {
  Json options = Json::array();
  for (const OptionInfo& option : item.options) options.push_back(to_json(option));
  Json out{{"name", item.name}};
  if (!item.kind.empty()) out[is_protocol ? "version" : "kind"] = item.kind;
  if (item.is_oracle) out["oracle"] = true;
  out["summary"] = item.summary;
  out["options"] = std::move(options);
  return out;
}

/// Name, kind and summary; on a terminal in lines that fit, otherwise in one.
void print_summary(const Item& item) {
  std::string text = item.summary;
  if (!item.kind.empty()) {
    text = fmt::format("[{}{}] {}", item.kind, item.is_oracle ? ", oracle" : "", item.summary);
  }
  const std::size_t columns = standard_output_style().width;
  fmt::print("{}",
             columns == 0 ? fmt::format("{:<22} {}\n", item.name, text)
                          : beside(item.name, text, 24, columns));
}

void print_options(const Item& item) {
  for (const OptionInfo& o : item.options) {
    const std::string rule = o.rule.empty() ? "" : fmt::format(" ({})", o.rule);
    const std::string line = fmt::format("{} = {}{}: {}", o.name, to_text(o.value), rule, o.help);
    const std::size_t columns = standard_output_style().width;
    const std::vector<std::string> lines = wrapped(line, columns == 0 ? 0 : columns - 8);
    for (std::size_t l = 0; l < lines.size(); ++l) {
      fmt::print("{}{}\n", l == 0 ? "    " : "        ", lines[l]);
    }
  }
}

/// "rarely used  jerk, ...".
void print_names(const std::vector<Item>& rarely_used) {
  std::string names;
  for (const Item& item : rarely_used) names += (names.empty() ? "" : ", ") + item.name;
  if (!names.empty()) print_summary({"rarely used", "", names, {}});
}

/// The summary of each entry; if `with_options`, its options, too. Protocols share theirs.
void print(const std::string& subject, const std::vector<Item>& all, bool with_options) {
  const bool is_shared = subject == "protocols";
  for (const Item& item : all) {
    print_summary(item);
    if (with_options && !is_shared) print_options(item);
  }
  if (!with_options || !is_shared) return;
  fmt::print("settings with the defaults of {} (usage: protocol: {{base: NAME, SETTING: VALUE}})\n",
             all.front().name);
  print_options(all.front());
}

struct ItemList {
  std::string subject;
  std::vector<Item> items;
  bool is_selected = false;  ///< by name or pattern, not as a complete list
};

bool is_pattern(const std::string& word) { return word.find_first_of("*?[") != std::string::npos; }

bool matches(const std::string& name, const std::string& wanted) {
  return fnmatch(wanted.c_str(), name.c_str(), 0) == 0;
}

/// The lists that the words name: all, one of them, or the entries with that name or pattern.
std::vector<ItemList> wanted_lists(const Catalogue& known, const ListArguments& arguments) {
  const bool has_subject = std::ranges::count(kSubjects, arguments.subject) > 0;
  const std::string wanted = has_subject ? arguments.name : arguments.subject;
  if (!has_subject && !arguments.name.empty()) {
    throw InputError(unknown_name("list", arguments.subject, kSubjects));
  }
  std::vector<ItemList> out;
  std::vector<std::string> names;
  if (!has_subject) names = kSubjects;
  for (const std::string& subject : kSubjects) {
    if (has_subject && subject != arguments.subject) continue;
    ItemList one{subject, items(known, subject), !wanted.empty()};
    for (const Item& item : one.items) names.push_back(item.name);
    if (one.is_selected) {
      std::erase_if(one.items, [&](const Item& item) { return !matches(item.name, wanted); });
    }
    if (!one.items.empty()) out.push_back(std::move(one));
  }
  if (!out.empty()) return out;
  if (is_pattern(wanted)) throw InputError("list: no name matches '" + wanted + "'");
  const bool is_close = !closest(wanted, names).empty();
  throw InputError(unknown_name(
      has_subject ? arguments.subject.substr(0, arguments.subject.size() - 1) : "list or entry",
      wanted,
      is_close || has_subject ? names : kSubjects));
}

int list(const ListArguments& arguments) {
  const Catalogue known = catalogue(arguments.plugins);
  std::vector<ItemList> lists = wanted_lists(known, arguments);
  if (arguments.json) {
    Json json;
    for (const ItemList& one : lists) {
      json[one.subject] = Json::array();
      for (const Item& item : one.items) {
        json[one.subject].push_back(to_json(item, one.subject == "protocols"));
      }
    }
    if (arguments.subject.empty()) json["keys"] = config_json();
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return kExitOk;
  }
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const bool has_title = lists.size() > 1;
    if (has_title) fmt::print("{}== {} ==\n", i == 0 ? "" : "\n", lists[i].subject);
    std::vector<Item> rare = lists[i].items;
    const auto is_rare = [](const Item& item) {
      return std::ranges::count(kRarelyUsed, item.name) > 0;
    };
    if (has_title && !lists[i].is_selected) std::erase_if(lists[i].items, is_rare);
    print(lists[i].subject, lists[i].items, lists[i].is_selected);
    std::erase_if(rare, std::not_fn(is_rare));
    if (has_title && !lists[i].is_selected) print_names(rare);
  }
  if (!lists.front().is_selected) {
    const std::string name = program_name();
    fmt::print("\n{}\n",
               fitted(fmt::format(
                   "options: {} list NAME, or a pattern: {} list methods 'dm*'", name, name)));
  }
  return kExitOk;
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ListArguments>();
  ListArguments& a = *arguments;
  CLI::App& command = *app.add_subcommand(
      "list", "List datasets, methods, metrics and protocols, or the options of one");
  add(command,
      "subject",
      a.subject,
      "datasets, methods, metrics, protocols, or the name or pattern of entries");
  add(command, "name", a.name, "name or pattern ('dm*') of entries of that list");
  add(command, "--plugin FILE", a.plugins, "Shared object with methods, datasets or metrics")
      ->allow_extra_args(false);
  command.add_flag(
      "--json",
      a.json,
      "Print names, options with type, unit, range and default, and the keys of configs as JSON");
  command.callback([arguments, &exit_code] { exit_code = list(*arguments); });
}

}  // namespace loopbench::harness
