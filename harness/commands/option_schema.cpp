#include "harness/commands/option_schema.hpp"

#include <cstdlib>
#include <sstream>

namespace loopbench::harness {
namespace {

/// "0 <= share <= 1", "order >= ..." and "step > 0", separated by commas, as bounds.
void add_bounds(Json& out, const OptionInfo& option) {
  const std::string above = option.name + " > ";
  const std::string from = " <= " + option.name;
  for (std::size_t begin = 0; begin < option.rule.size();) {
    const std::size_t end = std::min(option.rule.find(", ", begin), option.rule.size());
    const std::string rule = option.rule.substr(begin, end - begin);
    begin = end + 2;
    const std::size_t name = rule.find(from);
    if (rule.starts_with(above)) {
      out["exclusiveMinimum"] = std::strtod(rule.c_str() + above.size(), nullptr);
    } else if (name != std::string::npos) {
      out["minimum"] = std::strtod(rule.c_str(), nullptr);
      const std::size_t most = rule.find(" <= ", name + from.size());
      if (most != std::string::npos) {
        out["maximum"] = std::strtod(rule.c_str() + most + 4, nullptr);
      }
    }
  }
}

/// The words of "none | slerp".
Json words(const std::string& rule) {
  Json out = Json::array();
  std::istringstream in(rule);
  for (std::string word; in >> word;) {
    if (word != "|") out.push_back(word);
  }
  return out;
}

/// A name in the path of a reference.
std::string pointer(std::string name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '~' || name[i] == '/') name.replace(i, 1, name[i] == '~' ? "~0" : "~1");
  }
  return name;
}

}  // namespace

Json option_schema(const OptionInfo& option, const std::function<bool(const Params&)>& accepts) {
  Json out{{"description", option.help},
           {"default", std::visit([](const auto& value) { return Json(value); }, option.value)}};
  if (option.is_text) {
    if (!option.rule.empty()) {
      out["enum"] = words(option.rule);
    } else {
      out["type"] = {"string", "number", "boolean"};  // texts are read as they are written
    }
  } else if (std::holds_alternative<bool>(option.value)) {
    out["type"] = "boolean";
  } else if (std::holds_alternative<std::int64_t>(option.value)) {
    out["type"] = "integer";
    add_bounds(out, option);
  } else {
    out["type"] = "number";
    add_bounds(out, option);
    if (accepts({{option.name, std::string("none")}})) {
      out["type"] = {"number", "string"};
      out["pattern"] = "^none$";
    }
  }
  return out;
}

Json with_help(const std::string& help, const Json& schema) {
  Json out{{"description", help}};
  out.update(schema);
  return out;
}

Json map_of(Json properties, Json required) {
  Json out{{"type", "object"}, {"properties", std::move(properties)}};
  if (!required.is_null()) out["required"] = std::move(required);
  out["additionalProperties"] = false;
  return out;
}

Json one_of(Json names) { return {{"enum", std::move(names)}}; }

Json reference(const std::string& path) { return {{"$ref", "#/definitions/" + path}}; }

Json property_reference(const std::string& definition, const std::string& property) {
  return reference(pointer(definition) + "/properties/" + pointer(property));
}

void add_nested(Json& properties) {
  Json nested = Json::object();
  for (const auto& [name, schema] : properties.items()) {
    const std::size_t dot = name.find('.');
    if (dot != std::string::npos) nested[name.substr(0, dot)][name.substr(dot + 1)] = schema;
  }
  for (auto& [name, inner] : nested.items()) {
    add_nested(inner);
    const Json map{{"type", "object"}, {"properties", inner}, {"additionalProperties", false}};
    Json& property = properties[name];
    property = property.is_null() ? map : Json{{"anyOf", {property, map}}};
  }
}

Json values_schema() {
  const Json number{{"type", "number"}};
  const Json range{{"from", number},
                   {"to", number},
                   {"steps", {{"type", "integer"}, {"minimum", 1}, {"maximum", 100'000}}},
                   {"log", {{"type", "boolean"}}}};
  return {{"type", {"array", "object"}},
          {"minItems", 1},
          {"properties", range},
          {"required", {"from", "to", "steps"}},
          {"additionalProperties", false}};
}

Json grid_schema(const Json& options) {
  Json properties = Json::object();
  for (const auto& [name, schema] : options.items()) {
    properties[name] = {{"allOf", {reference("values")}}, {"items", schema}};
  }
  return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

}  // namespace loopbench::harness
