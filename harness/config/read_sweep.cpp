#include "harness/config/read_sweep.hpp"

#include <algorithm>
#include <set>

#include "datasets/formats/regular_file.hpp"
#include "harness/config/bytes.hpp"
#include "harness/config/choices.hpp"
#include "harness/config/exclusions.hpp"
#include "harness/config/protocol_choice.hpp"
#include "harness/config/setting_reader.hpp"
#include "harness/model/where.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLongestConfig = 16'000'000;  // [bytes]

const std::vector<std::string> kKeys{"description",
                                     "plugins",
                                     "datasets",
                                     "methods",
                                     "metrics",
                                     "times",
                                     "protocol",
                                     "baseline",
                                     "min_coverage",
                                     "repeats",
                                     "timing",
                                     "traces",
                                     "limits",
                                     "exclude",
                                     "table"};

/// With `timing: true`: enough runs for a median that one disturbance does not change.
constexpr int kRunsWhenAlone = 5;

/// Limits far above real sweeps, so that a few lines cannot request hours.
constexpr std::size_t kMostChoices = 10'000;  // of datasets, of methods, of metrics
constexpr std::size_t kMostRules = 1'000;     // exclusions

/// Parses one config; messages name its file. Collects its errors.
class SweepReader : private SettingReader {
 public:
  SweepReader(std::string file, const Catalogue& catalogue, Folders folders)
      : SettingReader(std::move(file)), catalogue_(catalogue), folders_(std::move(folders)) {}

  Sweep read(const YamlNode& root) const {
    try {
      return read_all(root);
    } catch (const CollectedErrors& errors) {
      throw InputError(errors.text);
    }
  }

 private:
  Sweep read_all(const YamlNode& root) const {
    if (root.type != YamlNode::Type::map) {
      throw input_error(file(), root.line, "expected a map with datasets, methods and metrics");
    }
    attempt([&] { only_keys(root, kKeys); });
    Sweep sweep;
    attempt([&] {
      sweep.datasets = list<DatasetChoice>(root, "datasets", [&](const auto&... entry) {
        return dataset_choices(entry..., folders_);
      });
    });
    attempt([&] { sweep.methods = list<MethodChoice>(root, "methods", method_choices); });
    optional(root, "protocol", [&](const YamlNode& node) {
      sweep.protocols = protocol_choices(node, file());
    });
    attempt([&] {
      sweep.metrics = list<MetricChoice>(root, "metrics", [&](const auto&... entry) {
        return metric_choices(entry..., sweep.protocols);
      });
    });
    optional(root, "times", [&](const YamlNode& node) { sweep.times = times(node); });
    optional(root, "plugins", [&](const YamlNode& node) { words(node, "plugins"); });
    optional(root, "description", [&](const YamlNode& node) { word(node, "description"); });
    optional(root, "min_coverage", [&](const YamlNode& node) {
      sweep.min_coverage = number(node, "min_coverage", "a number from 0 to 1", Between{0.0, 1.0});
    });
    optional(
        root, "repeats", [&](const YamlNode& node) { sweep.repeats = count(node, "repeats"); });
    optional(root, "timing", [&](const YamlNode& node) { read_timing(node, sweep); });
    optional(root, "limits", [&](const YamlNode& node) { sweep.limits = limits(node); });
    optional(root, "traces", [&](const YamlNode& node) { sweep.traces = flag(node, "traces"); });
    optional(root, "exclude", [&](const YamlNode& node) { sweep.exclude = exclusions(node); });
    optional(root, "table", [&](const YamlNode& node) { sweep.table = table(node); });
    // Without errors, because the labels of rejected methods are missing.
    if (!has_errors()) {
      attempt([&] { sweep.baseline = baseline(root.find("baseline"), sweep.methods); });
      optional(root, "exclude", [&](const auto& node) { require_matches(node, sweep, file()); });
    }
    report_errors();
    return sweep;
  }

  /// A number of runs; true for timing cells alone; or {runs: N, serial: true}.
  void read_timing(const YamlNode& node, Sweep& sweep) const {
    if (node.type == YamlNode::Type::map) {
      only_keys(node, {"runs", "serial"});
      if (const YamlNode* runs = node.find("runs")) sweep.timing = count(*runs, "timing.runs");
      if (const YamlNode* alone = node.find("serial")) sweep.serial = flag(*alone, "timing.serial");
    } else if (const bool* alone = std::get_if<bool>(&node.scalar);
               node.type == YamlNode::Type::scalar && alone != nullptr) {
      sweep.serial = *alone;
      if (*alone) sweep.timing = kRunsWhenAlone;
    } else {
      sweep.timing = count(node, "timing");
    }
  }

  Limits limits(const YamlNode& node) const {
    map_of(node, "limits", {"seconds", "memory", "cells"});
    Limits out;
    if (const YamlNode* seconds = node.find("seconds")) {
      out.seconds = number(*seconds, "limits.seconds");
    }
    if (const YamlNode* memory = node.find("memory")) {
      const std::string text = word(*memory, "limits.memory");
      const auto bytes = text == "none" ? 0 : parse_bytes(text);
      if (!bytes) {
        throw input_error(file(), memory->line, "limits.memory: expected a size (2GiB) or none");
      }
      out.memory = *bytes;
    }
    if (const YamlNode* cells = node.find("cells"))
      out.cells = integer(*cells, "limits.cells", 1'000'000'000);
    return out;
  }

  template <class Choice, class Read>
  std::vector<Choice> list(const YamlNode& root, const std::string& key, Read choices) const {
    const YamlNode* node = root.find(key);
    if (node == nullptr) throw input_error(file(), root.line, "'" + key + "' is missing");
    if (node->type != YamlNode::Type::list || node->list.empty()) {
      throw input_error(file(), node->line, key + ": expected a list with at least one entry");
    }
    std::vector<Choice> out;
    std::set<std::string> labels;
    for (const YamlNode& entry : node->list) {
      std::vector<Choice> expanded;
      attempt([&] { expanded = choices(entry, file(), catalogue_); });
      for (Choice& choice : expanded) {
        if (labels.size() == kMostChoices) {
          throw input_error(file(), entry.line, key + ": expands to more than 10000 entries");
        }
        if (!labels.insert(choice.label).second) {
          throw input_error(
              file(),
              entry.line,
              "two entries of " + key + " have the label '" + choice.label + "'; set label in one");
        }
        out.push_back(std::move(choice));
      }
    }
    return out;
  }

  std::vector<metrics::Times> times(const YamlNode& node) const {
    std::vector<metrics::Times> out;
    for (const std::string& name : words(node, "times")) {
      const auto value = from_text<metrics::Times>(name);
      if (!value)
        throw input_error(file(), node.line, "times: expected " + choice_list<metrics::Times>());
      if (std::ranges::count(out, *value) == 0) out.push_back(*value);
    }
    if (out.empty())
      throw input_error(file(), node.line, "times: expected " + choice_list<metrics::Times>());
    return out;
  }

  std::vector<Exclusion> exclusions(const YamlNode& node) const {
    std::vector<Exclusion> out;
    if (node.type != YamlNode::Type::list) {
      throw input_error(
          file(), node.line, "exclude: expected a list of {dataset, method} patterns");
    }
    if (node.list.size() > kMostRules) {
      throw input_error(file(), node.line, "exclude: more than 1000 entries");
    }
    for (const YamlNode& entry : node.list) {
      map_of(entry, "exclude", {"dataset", "method"});
      Exclusion exclusion;
      if (const YamlNode* d = entry.find("dataset")) exclusion.dataset = pattern(*d, "dataset");
      if (const YamlNode* m = entry.find("method")) exclusion.method = pattern(*m, "method");
      out.push_back(exclusion);
    }
    return out;
  }

  /// Adds file, line and, if given, key to the InputError of `read`.
  template <class Read>
  void checked(const YamlNode& node, const std::string& key, Read read) const {
    try {
      read();
    } catch (const InputError& error) {
      const std::string place = key.empty() ? "" : key + ": ";
      throw input_error(file(), node.line, place + error.what());
    }
  }

  /// Names of fields of a record.
  std::vector<std::string> fields(const YamlNode& node, const std::string& key) const {
    std::vector<std::string> out = words(node, key);
    checked(node, "table." + key, [&] {
      for (const std::string& name : out) field(Record{}, name);
    });
    return out;
  }

  TableSpec table(const YamlNode& node) const {
    map_of(node, "table", {"rows", "columns", "split", "value", "show", "where", "plus_minus"});
    TableSpec out;
    if (const YamlNode* rows = node.find("rows")) out.rows = fields(*rows, "rows");
    if (const YamlNode* columns = node.find("columns")) out.columns = fields(*columns, "columns");
    if (const YamlNode* split = node.find("split")) out.split = fields(*split, "split");
    if (const YamlNode* show = node.find("show")) out.show = words(*show, "show");
    if (const YamlNode* statistic = node.find("value")) {
      out.value = word(*statistic, "value");
      checked(*statistic, "table.value", [&] { value(Record{}, out.value); });
    }
    if (const YamlNode* on = node.find("plus_minus")) out.plus_minus = flag(*on, "plus_minus");
    if (const YamlNode* rules = node.find("where")) {
      out.where = words(*rules, "where");
      checked(*rules, "", [&] { where(out.where); });
    }
    return out;
  }

  std::string baseline(const YamlNode* node, const std::vector<MethodChoice>& methods) const {
    std::vector<std::string> labels;
    for (const MethodChoice& method : methods) labels.push_back(method.label);
    if (node == nullptr) {
      for (const char* usual : {"raw", "raw + polyline", "polyline"}) {
        if (std::ranges::count(labels, usual) > 0) return usual;
      }
      return "";
    }
    const std::string name = word(*node, "baseline");
    if (std::ranges::count(labels, name) == 0) {
      throw input_error(file(), node->line, "baseline: " + unknown_name("method", name, labels));
    }
    return name;
  }

  const Catalogue& catalogue_;
  Folders folders_;  // where relative paths are searched
};

}  // namespace

Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue,
                  const std::filesystem::path& data) {
  Folders folders{file.parent_path().empty() ? "." : file.parent_path()};
  if (!data.empty()) folders.push_back(data);
  Sweep sweep =
      SweepReader(file.string(), catalogue, folders).read(parse_yaml(text, file.string()));
  sweep.name = file.stem().string();
  sweep.config = file;
  sweep.text = text;
  return sweep;
}

std::vector<std::filesystem::path> with_config_plugins(std::vector<std::filesystem::path> given,
                                                       const std::filesystem::path& file) {
  const YamlNode root =
      parse_yaml(read_named_file(file, kLongestConfig, "a YAML config"), file.string());
  const YamlNode* node = root.type == YamlNode::Type::map ? root.find("plugins") : nullptr;
  if (node == nullptr) return given;
  std::vector<YamlNode> entries = node->list;
  if (node->type == YamlNode::Type::scalar) entries = {*node};
  for (const YamlNode& entry : entries) {
    const auto* text = std::get_if<std::string>(&entry.scalar);
    if (entry.type != YamlNode::Type::scalar || text == nullptr) continue;  // see read_sweep()
    const std::filesystem::path plugin = file.parent_path() / *text;
    std::error_code none;
    const auto is_same = [&](const auto& other) {
      return std::filesystem::equivalent(other, plugin, none);
    };
    if (std::ranges::none_of(given, is_same)) given.push_back(plugin);
  }
  return given;
}

Sweep read_sweep(const std::filesystem::path& file,
                 const Catalogue& catalogue,
                 const std::filesystem::path& data) {
  return parse_sweep(read_named_file(file, kLongestConfig, "a YAML config"), file, catalogue, data);
}

}  // namespace loopbench::harness
