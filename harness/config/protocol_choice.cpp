#include "harness/config/protocol_choice.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/config/source_text.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {

metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes) {
  std::vector<std::string> names;
  for (const metrics::ProtocolEntry& entry : metrics::protocols()) names.push_back(entry.name);
  if (std::ranges::count(names, name) == 0) throw InputError(unknown_name("protocol", name, names));
  return metrics::named_protocol(name, changes);
}

metrics::NamedProtocol protocol_choice(const YamlNode& node, const std::string& file) {
  std::string base = metrics::NamedProtocol{}.name;
  std::size_t base_line = node.line;
  std::vector<Setting> settings;
  if (node.type == YamlNode::Type::scalar) {
    base = node.text;
  } else if (node.type == YamlNode::Type::map) {
    if (node.find("sweep") != nullptr || node.find("zip") != nullptr) {
      throw input_error(file, node.line, "protocol: cannot be swept; use a list of protocols");
    }
    if (const YamlNode* given = node.find("base")) {
      if (given->type != YamlNode::Type::scalar) {
        throw input_error(file, given->line, "protocol: base: expected a name");
      }
      base = given->text;
      base_line = given->line;
    }
    settings = expand(node, {"base"}, file).front().settings;
    restore_text_options(settings, describe(metrics::Protocol{}));
  } else {
    throw input_error(file, node.line, "protocol: expected a name or a map with 'base: NAME'");
  }
  Params changes;
  for (const Setting& setting : settings) changes[setting.name] = setting.value;
  try {
    return known_protocol(base, changes);
  } catch (const InputError& error) {
    throw input_error(file, base_line, std::string("protocol: ") + error.what());
  } catch (const OptionError& error) {
    const auto found = std::ranges::find(settings, error.option(), &Setting::name);
    const std::size_t line = found == settings.end() ? node.line : found->line;
    throw input_error(file, line, std::string("protocol: ") + error.what());
  }
}

std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node,
                                                     const std::string& file) {
  if (node.type != YamlNode::Type::list) return {protocol_choice(node, file)};
  constexpr std::size_t kMost = 1'000;
  if (node.list.size() > kMost) {
    throw input_error(file, node.line, "protocol: more than 1000 entries");
  }
  std::vector<metrics::NamedProtocol> out;
  for (const YamlNode& item : node.list) {
    out.push_back(protocol_choice(item, file));
    const std::string label = out.back().label();
    if (std::ranges::count(out, label, &metrics::NamedProtocol::label) > 1) {
      throw input_error(file, item.line, "protocol: '" + label + "' is listed twice");
    }
  }
  if (out.empty()) throw input_error(file, node.line, "protocol: is empty, expected a name");
  return out;
}

}  // namespace loopbench::harness
