#include "harness/commands/entry_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace loopbench::harness {
namespace {

template <class Entry>
Json names(const std::vector<Entry>& entries) {
  Json out = Json::array();
  for (const Entry& entry : entries) out.push_back(entry.name);
  return out;
}

/// Whether the entry has a value for these options.
bool accepts(const DatasetEntry& entry, const Params& options) try {
  entry.check(options);
  return true;
} catch (const OptionError&) {
  return false;
}
bool accepts(const metrics::MetricEntry& entry, const Params& options) try {
  entry.check(options);
  return true;
} catch (const OptionError&) {
  return false;
}
bool accepts(const methods::MethodEntry& entry, const Params& options) try {
  if (entry.make_oracle) {
    entry.make_oracle(options, {});
  } else {
    entry.make(options);
  }
  return true;
} catch (const std::exception&) {
  return false;
}

/// Schema of the map of one entry, whose options are its properties.
template <class Entry>
Json entry_schema(const std::string& kind, const Entry& entry) {
  const std::string id = kind + "." + entry.name;
  Json options = Json::object();
  Json references = Json::object();
  for (const OptionInfo& option : entry.options) {
    options[option.name] =
        option_schema(option, [&](const Params& given) { return accepts(entry, given); });
    references[option.name] = property_reference(id, option.name);
  }
  Json properties{{kind, true}, {"label", true}, {"sweep", true}, {"zip", true}};
  if (kind == "dataset") properties["group"] = true;
  Json nested = references;
  add_nested(nested);
  for (const auto& [name, schema] : nested.items()) {
    properties[name] =
        options.contains(name) && schema == references[name] ? options[name] : schema;
  }
  properties["sweep"] = grid_schema(references);
  properties["zip"] = property_reference(id, "sweep");
  return with_help(entry.summary, map_of(properties));
}

/// A list of names, or maps whose options depend on the name.
Json list_schema(const std::string& kind, const Json& known, const Json& by_name) {
  Json map{{"type", "object"},
           {"required", {kind}},
           {"properties", {{kind, known}, {"label", with_help("name in tables", kText)}}},
           {"allOf", by_name}};
  if (kind == "dataset") {
    map["properties"]["group"] = with_help("name of runs that are not independent", kText);
  }
  return {{"type", "array"},
          {"minItems", 1},
          {"items",
           {{"type", {"string", "object"}},
            {"if", {{"type", "string"}}},
            {"then", known},
            {"else", map}}}};
}

Json if_name(const std::string& kind, const Json& name, const std::string& definition) {
  return {{"if", {{"required", {kind}}, {"properties", {{kind, name}}}}},
          {"then", reference(definition)}};
}

/// Adds the entries to the definitions, and returns a reference for each name.
template <class Entry>
Json define(Json& definitions, const std::string& kind, const std::vector<Entry>& entries) {
  Json out = Json::array();
  for (const Entry& entry : entries) {
    definitions[kind + "." + entry.name] = entry_schema(kind, entry);
    out.push_back(if_name(kind, {{"const", entry.name}}, kind + "." + entry.name));
  }
  return out;
}

std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Matches texts "corrector + smoother", and "replay + " any method or these.
std::string composed_pattern(const std::vector<methods::MethodEntry>& entries) {
  std::map<methods::Kind, std::vector<std::string>> names;
  for (const methods::MethodEntry& entry : entries) {
    names[entry.kind].push_back(escaped(entry.name));
  }
  const auto any = [&](methods::Kind kind) {
    return fmt::format("({})", fmt::join(names[kind], "|"));
  };
  const std::string corrector = any(methods::Kind::corrector);
  const std::string smoother = any(methods::Kind::smoother);
  const std::string two = fmt::format(R"({}\s*\+\s*{})", corrector, smoother);
  const std::string one = fmt::format("({}|{}|{})", corrector, smoother, any(methods::Kind::joint));
  return fmt::format(R"(^\s*({0}|{1}\s*\+\s*({0}|{2}))\s*$)", two, any(methods::Kind::replay), one);
}

/// What an option accepts, for comparison.
Json accepted(Json schema) {
  schema.erase("default");
  schema.erase("description");
  return schema;
}

/// Composed methods: an option belongs to one of the stages, whose name can precede it. Options
/// of the same name can differ between methods: the schema is that of any of them.
Json composed_schema(const std::vector<methods::MethodEntry>& entries, const Json& definitions) {
  std::map<std::string, std::vector<std::string>> having;
  std::map<std::string, std::vector<Json>> seen;
  Json options = Json::object();
  Json swept = Json::object();
  for (const methods::MethodEntry& entry : entries) {
    const std::string id = "method." + entry.name;
    for (const OptionInfo& option : entry.options) {
      const std::string& name = option.name;
      const Json one = property_reference(id, name);
      options[entry.name + "." + name] = one;
      swept[entry.name + "." + name] = one;
      swept[name] = property_reference("composed", name);
      having[name].push_back(escaped(entry.name));
      const Json own = accepted(definitions.at(id).at("properties").at(name));
      if (std::ranges::count(seen[name], own) > 0) continue;
      seen[name].push_back(own);
      options[name]["anyOf"].push_back(one);
    }
  }
  add_nested(options);
  Json keys{{"method", true}, {"label", true}};
  keys.update(options);
  keys["sweep"] = grid_schema(swept);
  keys["zip"] = property_reference("composed", "sweep");
  Json out = map_of(keys);
  for (const auto& [option, methods] : having) {
    out["dependencies"][option]["properties"]["method"]["pattern"] =
        fmt::format(R"((^|\+)\s*({})\s*($|\+))", fmt::join(methods, "|"));
  }
  return out;
}

}  // namespace

Json list_schemas(const Catalogue& catalogue, Json& definitions) {
  const Json datasets = define(definitions, "dataset", catalogue.datasets);
  Json methods = define(definitions, "method", catalogue.methods);
  const Json metrics = define(definitions, "metric", catalogue.metrics);
  definitions["composed"] = composed_schema(catalogue.methods, definitions);
  // Without anyOf, so that validators list the names.
  const Json name{{"if", {{"pattern", "\\+"}}},
                  {"then", {{"pattern", composed_pattern(catalogue.methods)}}},
                  {"else", one_of(names(catalogue.methods))}};
  methods.push_back(if_name("method", {{"pattern", "\\+"}}, "composed"));
  return {{"datasets", list_schema("dataset", one_of(names(catalogue.datasets)), datasets)},
          {"methods", list_schema("method", name, methods)},
          {"metrics", list_schema("metric", one_of(names(catalogue.metrics)), metrics)}};
}

}  // namespace loopbench::harness
