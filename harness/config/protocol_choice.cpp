#include "harness/config/protocol_choice.hpp"

#include <algorithm>

#include "harness/base/suggest.hpp"
#include "harness/config/source_text.hpp"
#include "harness/config/values.hpp"

namespace loopbench::harness {

metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes) {
  std::vector<std::string> names;
  for (const metrics::ProtocolEntry& entry : metrics::protocols()) names.push_back(entry.name);
  if (std::ranges::count(names, name) == 0) throw InputError(unknown_name("protocol", name, names));
  return metrics::named_protocol(name, changes);
}

namespace {

/// `evo`, or `{base: evo, max_diff: 0.02, segments: {step: 5}}`; the default base is loopbench.
metrics::NamedProtocol protocol_choice(const YamlNode& node) {
  std::string base = metrics::NamedProtocol{}.name;
  Place base_place = node;
  std::vector<Setting> settings;
  if (node.type == YamlNode::Type::scalar) {
    base = node.text;
  } else {
    require_map(node, "protocol", "a name or a map with 'base: NAME'");
    if (node.find("sweep") != nullptr || node.find("zip") != nullptr) {
      throw node.error("protocol: cannot be swept; use a list of protocols");
    }
    if (const YamlNode* given = node.find("base")) {
      base = as_text(*given, "protocol: base");
      base_place = *given;
    }
    settings = expand(node, {"base"}).front().settings;
    restore_text_options(settings, describe(metrics::Protocol{}));
  }
  try {
    return known_protocol(base, to_params(settings));
  } catch (const InputError& error) {
    throw base_place.error(std::string("protocol: ") + error.what());
  } catch (const OptionError& error) {
    const auto found = std::ranges::find(settings, error.option(), &Setting::name);
    const Place place = found == settings.end() ? Place(node) : found->place;
    throw place.error(std::string("protocol: ") + error.what());
  }
}

}  // namespace

std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node) {
  if (node.type != YamlNode::Type::list) return {protocol_choice(node)};
  constexpr std::size_t kMost = 1'000;
  if (node.list.size() > kMost) throw node.error("protocol: more than 1000 entries");
  std::vector<metrics::NamedProtocol> out;
  for (const YamlNode& item : node.list) {
    out.push_back(protocol_choice(item));
    const std::string label = out.back().label();
    if (std::ranges::count(out, label, &metrics::NamedProtocol::label) > 1) {
      throw item.error("protocol: '" + label + "' is listed twice");
    }
  }
  if (out.empty()) throw node.error("protocol: is empty, expected a name");
  return out;
}

}  // namespace loopbench::harness
