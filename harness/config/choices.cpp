#include "harness/config/choices.hpp"

#include <algorithm>
#include <map>

#include "harness/config/calibration.hpp"
#include "harness/config/grid.hpp"
#include "harness/config/method_text.hpp"
#include "harness/config/source_text.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

/// Runs `check`; adds file and line of the option to its errors.
template <class Check>
void located(const std::string& file,
             std::size_t entry_line,
             const std::string& name,
             const std::vector<Setting>& settings,
             const std::vector<OptionInfo>& options,
             Check check) {
  try {
    check();
  } catch (const OptionError& error) {
    std::size_t line = entry_line;
    for (const Setting& setting : settings) {
      if (setting.name == error.option()) line = setting.line;
    }
    std::vector<std::string> known;
    for (const OptionInfo& option : options) known.push_back(option.name);
    const bool is_explained = std::ranges::count(known, error.option()) > 0;
    const std::string guess = is_explained ? "" : closest(error.option(), known);
    std::string why = error.what();  // the guess precedes the list of all options
    if (!guess.empty()) {
      why.insert(std::min(why.find(" (has: "), why.size()), "; did you mean '" + guess + "'?");
    }
    throw input_error(file, line, name + ": " + why);
  }
}

Params to_params(const std::vector<Setting>& settings) {
  Params out;
  for (const Setting& setting : settings) out[setting.name] = setting.value;
  return out;
}

/// "name (a=1, b=2)". If the entry has a label, only the swept settings are listed.
std::string label_of(const std::string& name, const std::string& given, const GridPoint& point) {
  std::string shown;
  for (const Setting& setting : point.settings) {
    if (!given.empty() && std::ranges::count(point.swept, setting.name) == 0) continue;
    shown += (shown.empty() ? "" : ", ") + setting.name + "=" + to_text(setting.value);
  }
  if (!given.empty()) {
    for (const std::string& text : point.matched) shown += (shown.empty() ? "" : ", ") + text;
  }
  const std::string& base = given.empty() ? name : given;
  return shown.empty() ? base : base + " (" + shown + ")";
}

/// The entry's name under `key`, or the entry itself if it is a string, and its label.
struct Named {
  std::string name;
  std::string label;
};

Named named(const YamlNode& entry, const std::string& key, const std::string& file) {
  if (entry.type == YamlNode::Type::scalar) return {entry.text, ""};
  const YamlNode* name = entry.find(key);
  if (entry.type != YamlNode::Type::map || name == nullptr ||
      name->type != YamlNode::Type::scalar) {
    throw input_error(file, entry.line, "expected a name or a map with '" + key + ": NAME'");
  }
  const YamlNode* label = entry.find("label");
  if (label != nullptr && label->type != YamlNode::Type::scalar) {
    throw input_error(file, label->line, "label: expected a string");
  }
  return {name->text, label == nullptr ? "" : label->text};
}

template <class Find>
const auto& found(Find find,
                  const Catalogue& catalogue,
                  const std::string& name,
                  const std::string& file,
                  std::size_t line) {
  try {
    return find(catalogue, name);
  } catch (const InputError& error) {
    throw input_error(file, line, error.what());
  }
}

/// The stage of a setting and its name in that stage: `uniform.rotation`, or `rotation` if only one
/// stage has this option.
std::pair<std::size_t, std::string> stage_of(const Setting& setting,
                                             const std::vector<const methods::MethodEntry*>& stages,
                                             const std::string& file) {
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
    throw input_error(file,
                      setting.line,
                      setting.name + ": both stages have this option; use " + stages[0]->name +
                          "." + setting.name + " or " + stages[1]->name + "." + setting.name);
  }
  if (stages.size() == 1) return {0, setting.name};  // the stage rejects it and lists its options
  throw input_error(
      file, setting.line, unknown_name("option of either stage", setting.name, known));
}

}  // namespace

std::vector<DatasetChoice> dataset_choices(const YamlNode& entry,
                                           const std::string& file,
                                           const Catalogue& catalogue,
                                           const Folders& folders) {
  const auto [name, label] = named(entry, "dataset", file);
  const DatasetEntry& known = found(find_dataset, catalogue, name, file, entry.line);
  const YamlNode* group = entry.find("group");
  if (group != nullptr && group->type != YamlNode::Type::scalar) {
    throw input_error(file, group->line, "group: expected a string");
  }
  std::vector<DatasetChoice> out;
  std::vector<GridPoint> points;
  for (const GridPoint& point : expand(entry, {"dataset", "label", "group"}, file)) {
    for (GridPoint& each : expand_paths(point, known.options, folders, file)) {
      points.push_back(std::move(each));
    }
  }
  for (GridPoint& point : points) {
    restore_text_options(point.settings, known.options);
    const Params options = to_params(point.settings);
    located(file, entry.line, name, point.settings, known.options, [&] { known.check(options); });
    out.push_back(
        {label_of(name, label, point), {name, options}, group == nullptr ? "" : group->text});
  }
  return out;
}

std::vector<MetricChoice> metric_choices(const YamlNode& entry,
                                         const std::string& file,
                                         const Catalogue& catalogue,
                                         const std::vector<metrics::NamedProtocol>& protocols) {
  const auto [name, label] = named(entry, "metric", file);
  const metrics::MetricEntry& known = found(find_metric, catalogue, name, file, entry.line);
  std::vector<MetricChoice> out;
  for (GridPoint& point : expand(entry, {"metric", "label"}, file)) {
    restore_text_options(point.settings, known.options);
    const Params options = to_params(point.settings);
    located(file, entry.line, name, point.settings, known.options, [&] {
      known.check(options);
      if (!known.check_protocol) return;
      for (const metrics::NamedProtocol& protocol : protocols)
        known.check_protocol(options, protocol.rules);
    });
    out.push_back({label_of(name, label, point), {name, options}});
  }
  return out;
}

std::vector<MethodChoice> method_choices(const YamlNode& entry,
                                         const std::string& file,
                                         const Catalogue& catalogue) {
  const auto [text, label] = named(entry, "method", file);
  std::vector<const methods::MethodEntry*> stages;
  for (const std::string& name : split_stages(text)) {
    stages.push_back(&found(find_method, catalogue, name, file, entry.line));
  }
  if (const std::string why = why_not_composable(stages); !why.empty()) {
    throw input_error(file, entry.line, text + ": " + why);
  }
  CalibratedSettings calibrated;
  if (const YamlNode* node = entry.find("calibration")) {
    if (node->type != YamlNode::Type::scalar) {
      throw input_error(file, node->line, "calibration: expected a file name");
    }
    std::vector<std::string> names;
    for (const methods::MethodEntry* stage : stages) names.push_back(stage->name);
    calibrated = read_calibration(node->text, names, file, node->line);
  }
  std::vector<MethodChoice> out;
  for (GridPoint& point : expand(entry, {"method", "label", "calibration"}, file)) {
    std::vector<std::vector<Setting>> by_stage(stages.size());
    for (Setting& setting : point.settings) {
      const auto [stage, name] = stage_of(setting, stages, file);
      std::vector<Setting> own{{name, setting.value, setting.line, setting.text}};
      restore_text_options(own, stages[stage]->options);
      setting.value = own.front().value;
      by_stage[stage].push_back(own.front());
    }
    MethodChoice choice{label_of(text, label, point), {}, calibrated.trained_on};
    for (const methods::MethodEntry* stage : stages) choice.stages.push_back({stage->name, {}});
    for (std::size_t i = 0; i < stages.size(); ++i) {
      for (const Setting& estimated :
           calibrated.by_method[stages[i]->name]) {  // the entry's own settings have priority
        if (std::ranges::count(by_stage[i], estimated.name, &Setting::name) == 0) {
          by_stage[i].push_back(estimated);
        }
      }
      choice.stages[i].options = to_params(by_stage[i]);
      located(file, entry.line, stages[i]->name, by_stage[i], stages[i]->options, [&] {
        if (is_joint(catalogue, *stages[i], choice.stages[i].options) && stages.size() > 1)
          throw OptionError("output",
                            "with these options it is a joint method and has no smoother");
      });
    }
    out.push_back(std::move(choice));
  }
  return out;
}

}  // namespace loopbench::harness
