#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "harness/commands/commands.hpp"
#include "harness/commands/entry_schema.hpp"
#include "harness/config/keys.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {
namespace {

const Json kFlag{{"type", "boolean"}};
const Json kCount{{"type", "integer"}, {"minimum", 1}, {"maximum", 1'000'000}};
const Json kTexts{{"type", {"string", "number", "boolean", "array"}}, {"items", kText}};

/// The keys of a map of the config with their schemas.
Json keys_of(const std::string& map, const std::map<std::string, Json>& schemas) {
  Json out = Json::object();
  for (const ConfigKey& key : config_keys(map)) {
    out[key.name] = with_help(key.help, schemas.at(key.name));
  }
  return out;
}

/// A name, or a map with changes.
Json protocol_schema() {
  Json known = Json::array();
  const std::vector<metrics::ProtocolEntry> all = metrics::protocols();
  for (const metrics::ProtocolEntry& entry : all) known.push_back(entry.name);
  Json properties{{"base", one_of(known)}};
  for (const OptionInfo& option : describe(all.front().protocol)) {
    properties[option.name] = option_schema(option, [](const Params& given) {
      try {
        metrics::named_protocol(metrics::NamedProtocol{}.name, given);
        return true;
      } catch (const OptionError&) {
        return false;
      }
    });
  }
  add_nested(properties);
  return {{"type", {"string", "object"}},
          {"if", {{"type", "string"}}},
          {"then", one_of(known)},
          {"else", map_of(properties)}};
}

Json times_schema() {
  Json known = Json::array();
  for (const auto& [name, value] : choices(metrics::Times{})) known.push_back(name);
  return {{"if", {{"type", "array"}}},
          {"then", {{"minItems", 1}, {"items", one_of(known)}}},
          {"else", one_of(known)}};
}

Json limits_schema() {
  return map_of(keys_of("limits",
                        {{"seconds", {{"type", "number"}, {"minimum", 0}}},
                         {"memory", {{"type", {"string", "integer"}}}},
                         {"processes", kCount},
                         {"cells", kCount}}));
}

Json timing_schema() {
  return {
      {"anyOf", {kCount, kFlag, map_of(keys_of("timing", {{"runs", kCount}, {"serial", kFlag}}))}}};
}

Json table_schema() {
  return map_of(keys_of("table",
                        {{"rows", kTexts},
                         {"columns", kTexts},
                         {"split", kTexts},
                         {"value", kText},
                         {"show", kTexts},
                         {"where", kTexts},
                         {"plus_minus", kFlag}}));
}

Json exclude_schema() {
  return {{"type", "array"},
          {"items", map_of(keys_of("exclude", {{"dataset", kText}, {"method", kText}}))}};
}

/// JSON Schema (draft 7) of configs, generated from the catalogue: what `list --json` prints, and
/// the keys that `run` accepts. Names of entries are checked unless a config lists plugins, whose
/// names it cannot contain.
Json config_schema(const Catalogue& catalogue) {
  Json definitions{{"values", values_schema()}, {"protocol", protocol_schema()}};
  const Json list{{"type", "array"}, {"minItems", 1}};
  const Json protocol = reference("protocol");
  Json properties = keys_of("",
                            {{"description", kText},
                             {"plugins", kTexts},
                             {"datasets", list},
                             {"methods", list},
                             {"metrics", list},
                             {"times", times_schema()},
                             {"protocol",
                              {{"if", {{"type", "array"}}},
                               {"then", {{"minItems", 1}, {"items", protocol}}},
                               {"else", protocol}}},
                             {"baseline", kText},
                             {"min_coverage", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
                             {"repeats", kCount},
                             {"timing", timing_schema()},
                             {"traces", kFlag},
                             {"limits", limits_schema()},
                             {"exclude", exclude_schema()},
                             {"table", table_schema()}});
  Json out{{"$schema", "http://json-schema.org/draft-07/schema#"},
           {"title", "config of loopbench"}};
  out.update(map_of(std::move(properties), {"datasets", "methods", "metrics"}));
  // Names with _ are for anchors. Validators list the others, as `run` does.
  Json names = Json::array();
  for (const auto& [name, schema] : out["properties"].items()) names.push_back(name);
  out.erase("additionalProperties");
  out["propertyNames"] = {{"if", {{"pattern", "^_"}}}, {"else", one_of(std::move(names))}};
  out["if"] = {{"required", {"plugins"}}};  // their names are not known here
  out["else"]["properties"] = list_schemas(catalogue, definitions);
  out["definitions"] = std::move(definitions);
  return out;
}

/// One line for each definition, so that changes can be read in the history of a file.
std::string text(const Json& schema) {
  const auto dump = [](const auto& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  std::string out;
  for (const auto& [key, value] : schema.items()) {
    out += (out.empty() ? "{\n" : ",\n") + dump(Json(key)) + ": ";
    if (key != "definitions") {
      out += dump(value);
      continue;
    }
    std::string lines;
    for (const auto& [name, definition] : value.items()) {
      lines += (lines.empty() ? "{\n" : ",\n") + dump(Json(name)) + ": " + dump(definition);
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
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->footer(
      "An editor with the YAML language server checks and completes a config whose first line is\n"
      "`# yaml-language-server: $schema=schema.json`, with the path of the printed file.");
  command->callback([plugins, &exit_code] {
    fmt::print("{}", text(config_schema(catalogue(*plugins))));
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
