#include "harness/sweep/config/choices.hpp"

#include <algorithm>

#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/config/values.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

/// Runs `check`; adds file and line of the option to its errors.
template <class Check>
void located(const ConfigEntry& entry,
             const std::string& name,
             const std::vector<Setting>& settings,
             Check check,
             const std::vector<std::string>& keys = {"label"}) {
  try {
    check();
  } catch (const OptionError& error) {
    const auto setting = std::ranges::find(settings, error.option(), &Setting::name);
    const Place& place = setting == settings.end() ? entry.place : setting->place;
    throw place.error(name + ": " + with_guess(error, keys));
  }
}

/// "name (a=1, b=2)". If the entry has a label or a pattern, only the swept settings and the texts
/// of the wildcards are listed.
std::string label_of(const ConfigEntry& entry, const GridPoint& point) {
  const bool is_short = !entry.label.empty() || !point.matched.empty();
  std::string shown;
  for (const Setting& setting : point.settings) {
    if (is_short && std::ranges::count(point.swept, setting.name) == 0) continue;
    shown += (shown.empty() ? "" : ", ") + setting.name + "=" + to_text(setting.value);
  }
  for (const std::string& text : point.matched) shown += (shown.empty() ? "" : ", ") + text;
  const std::string& base = entry.label.empty() ? entry.name : entry.label;
  return shown.empty() ? base : base + " (" + shown + ")";
}

template <class Find>
const auto& found(Find find,
                  const Catalogue& catalogue,
                  const std::string& name,
                  const Place& place) {
  try {
    return find(catalogue, name);
  } catch (const InputError& error) {
    throw place.error(error.what());
  }
}

using Stages = std::vector<const methods::MethodEntry*>;

std::size_t replays_in_front(const Stages& stages) {
  return stages.front()->kind == methods::Kind::replay ? 1 : 0;
}

/// Reason why these stages cannot be combined; empty for corrector, smoother, corrector + smoother,
/// method, and each of these after a replay, which can also be alone.
std::string why_not_composable(const Stages& stages) {
  const std::size_t first = replays_in_front(stages);
  const auto is = [&](std::size_t i, methods::Kind kind) {
    return stages[first + i]->kind == kind;
  };
  const std::size_t rest = stages.size() - first;
  if (rest == 0 || (rest == 1 && !is(0, methods::Kind::replay))) return "";
  if (rest == 2 && is(0, methods::Kind::corrector) && is(1, methods::Kind::smoother)) return "";
  std::string kinds;
  for (const methods::MethodEntry* stage : stages) {
    kinds += (kinds.empty() ? "" : " + ") + to_text(stage->kind);
  }
  return "is " + kinds + "; stages compose as corrector + smoother, after a replay if there is one";
}

/// The stage of a setting and its name in that stage: `uniform.rotation`, or `rotation` if only one
/// stage has this option.
std::pair<std::size_t, std::string> stage_of(const Setting& setting, const Stages& stages) {
  std::vector<std::size_t> having;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string prefix = stages[i]->name + ".";
    if (setting.name.starts_with(prefix)) return {i, setting.name.substr(prefix.size())};
    for (const OptionInfo& option : stages[i]->options) {
      known.push_back(option.name);
      if (option.name == setting.name) having.push_back(i);
    }
  }
  if (having.size() == 1) return {having.front(), setting.name};
  if (having.size() > 1) {
    throw setting.place.error(setting.name + ": both stages have this option; use " +
                              stages[having[0]]->name + "." + setting.name + " or " +
                              stages[having[1]]->name + "." + setting.name);
  }
  if (stages.size() == 1) return {0, setting.name};  // the stage rejects it and lists its options
  throw setting.place.error(unknown_name("option of either stage", setting.name, known));
}

std::vector<DatasetChoice> dataset_choices(const ConfigEntry& entry,
                                           const Catalogue& catalogue,
                                           const Folders& folders) {
  const DatasetEntry& known = found(find_dataset, catalogue, entry.name, entry.place);
  std::vector<DatasetChoice> out;
  std::vector<GridPoint> points;
  for (const GridPoint& point : entry.points) {
    for (GridPoint& each : expand_paths(point, known.options, folders)) {
      points.push_back(std::move(each));
    }
  }
  for (GridPoint& point : points) {
    restore_text_options(point.settings, known.options);
    const Params options = to_params(point.settings);
    located(entry, entry.name, point.settings, [&] { known.check(options); }, {"label", "group"});
    out.push_back({label_of(entry, point), {entry.name, options}});
  }
  return out;
}

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
    throw place.error("protocol: " + with_guess(error));
  }
}

/// Adds the name of a stage to the parts of its method.
void add_part(MethodParts& parts, const methods::MethodEntry& stage, const Choice& choice) {
  switch (stage.kind) {
    case methods::Kind::replay:
      parts.replay = stage.name;
      break;
    case methods::Kind::smoother:
      parts.smoother = stage.name;
      break;
    default:
      parts.corrector = stage.name;
  }
  for (const char* command : {"run", "serve"}) {
    const auto given = choice.options.find(command);
    if (is_program(choice) && given != choice.options.end()) parts.program = to_text(given->second);
  }
}

}  // namespace

std::vector<DatasetChoice> read_datasets(const YamlNode& entry,
                                         const Catalogue& catalogue,
                                         const Folders& folders) {
  std::string group;
  read_key(entry, "group", group, as_text);
  std::optional<metrics::Align> align;
  if (const YamlNode* rules = entry.find("protocol")) {
    if (rules->map.size() != 1 || rules->find("align") == nullptr) {
      throw rules->error("protocol of a dataset: expected {align: NAME}");
    }
    align = protocol_choices(*rules).front().rules.align;
  }
  std::vector<DatasetChoice> out =
      dataset_choices(read_entry(entry, "dataset", {"group", "protocol"}), catalogue, folders);
  for (DatasetChoice& choice : out) {
    choice.group = group;
    choice.align = align;
    choice.line = entry.line;
  }
  return out;
}

std::vector<MetricChoice> metric_choices(const ConfigEntry& entry,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols) {
  const metrics::MetricEntry& known = found(find_metric, catalogue, entry.name, entry.place);
  std::vector<MetricChoice> out;
  for (GridPoint point : entry.points) {
    restore_text_options(point.settings, known.options);
    const Params options = to_params(point.settings);
    located(entry, entry.name, point.settings, [&] {
      known.check(options);
      if (!known.check_protocol) return;
      for (const metrics::NamedProtocol& protocol : protocols)
        known.check_protocol(options, protocol.rules);
    });
    out.push_back({label_of(entry, point), {entry.name, options}});
  }
  return out;
}

std::vector<MethodChoice> method_choices(const ConfigEntry& entry, const Catalogue& catalogue) {
  Stages stages;
  for (const std::string& name : split_stages(entry.name)) {
    stages.push_back(&found(find_method, catalogue, name, entry.place));
  }
  if (const std::string why = why_not_composable(stages); !why.empty()) {
    throw entry.place.error(entry.name + ": " + why);
  }
  std::vector<MethodChoice> out;
  for (GridPoint point : entry.points) {
    std::vector<std::vector<Setting>> by_stage(stages.size());
    for (Setting& setting : point.settings) {
      const auto [stage, name] = stage_of(setting, stages);
      std::vector<Setting> own{{name, setting.value, setting.place, setting.text}};
      restore_text_options(own, stages[stage]->options);
      setting.value = own.front().value;
      by_stage[stage].push_back(own.front());
    }
    MethodChoice choice{label_of(entry, point), {}};
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const methods::MethodEntry& stage = *stages[i];
      const Params options = to_params(by_stage[i]);
      choice.stages.push_back({stage.name, options});
      add_part(choice.parts, stage, choice.stages.back());
      located(entry, stage.name, by_stage[i], [&] {
        if (is_joint(catalogue, stage, options) && stages.size() > 1 + replays_in_front(stages))
          throw OptionError("output",
                            "with these options it is a joint method and has no smoother");
      });
    }
    out.push_back(std::move(choice));
  }
  return out;
}

metrics::NamedProtocol known_protocol(const std::string& name, const Params& changes) {
  std::vector<std::string> names;
  for (const metrics::ProtocolEntry& entry : metrics::protocols()) names.push_back(entry.name);
  if (std::ranges::count(names, name) == 0) throw InputError(unknown_name("protocol", name, names));
  return metrics::named_protocol(name, changes);
}

std::vector<metrics::NamedProtocol> protocol_choices(const YamlNode& node) {
  if (node.type != YamlNode::Type::list) return {protocol_choice(node)};
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
