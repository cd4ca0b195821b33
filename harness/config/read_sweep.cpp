#include "harness/config/read_sweep.hpp"

#include <algorithm>
#include <set>

#include "datasets/formats/regular_file.hpp"
#include "harness/config/bytes.hpp"
#include "harness/config/choices.hpp"
#include "harness/config/protocol_choice.hpp"
#include "harness/model/where.hpp"
#include "harness/text/pattern.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

const std::vector<std::string> kKeys{"description",
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

/// Parses one config; messages name its file.
class SweepReader {
 public:
  SweepReader(std::string file, const Catalogue& catalogue)
      : file_(std::move(file)), catalogue_(catalogue) {}

  Sweep read(const YamlNode& root) const {
    if (root.type != YamlNode::Type::map) {
      throw input_error(file_, root.line, "expected a map with datasets, methods and metrics");
    }
    only_keys(root, kKeys);
    Sweep sweep;
    sweep.datasets = list<DatasetChoice>(root, "datasets", dataset_choices);
    sweep.methods = list<MethodChoice>(root, "methods", method_choices);
    if (const YamlNode* node = root.find("protocol"))
      sweep.protocols = protocol_choices(*node, file_);
    sweep.metrics = list<MetricChoice>(root, "metrics", [&](const auto&... entry) {
      return metric_choices(entry..., sweep.protocols);
    });
    if (const YamlNode* node = root.find("times")) sweep.times = times(*node);
    if (const YamlNode* node = root.find("description")) word(*node, "description");
    if (const YamlNode* node = root.find("min_coverage"))
      sweep.min_coverage = number(*node, "min_coverage", "a number from 0 to 1", Between{0.0, 1.0});
    if (const YamlNode* node = root.find("repeats")) sweep.repeats = count(*node, "repeats");
    if (const YamlNode* node = root.find("timing")) read_timing(*node, sweep);
    if (const YamlNode* node = root.find("limits")) sweep.limits = limits(*node);
    if (const YamlNode* node = root.find("traces")) sweep.traces = flag(*node, "traces");
    if (const YamlNode* node = root.find("exclude")) sweep.exclude = exclusions(*node);
    if (const YamlNode* node = root.find("table")) sweep.table = table(*node);
    sweep.baseline = baseline(root.find("baseline"), sweep.methods);
    return sweep;
  }

 private:
  /// Settings for which only a map with the `known` keys is accepted.
  void map_of(const YamlNode& node,
              const std::string& key,
              const std::vector<std::string>& known) const {
    if (node.type != YamlNode::Type::map) {
      std::string all;
      for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
      const std::string found = node.type == YamlNode::Type::scalar ? "'" + node.text + "'"
                                : node.type == YamlNode::Type::list ? "a list"
                                                                    : "nothing";
      throw input_error(file_, node.line, key + ": found " + found + ", expected a map of " + all);
    }
    only_keys(node, known);
  }

  void only_keys(const YamlNode& node, const std::vector<std::string>& known) const {
    for (const auto& [key, value] : node.map) {
      if (std::ranges::count(known, key) == 0) {
        throw input_error(file_, value.line, unknown_name("setting", key, known));
      }
    }
  }

  std::string word(const YamlNode& node, const std::string& key) const {
    if (node.type == YamlNode::Type::scalar) return node.text;
    throw input_error(file_, node.line, key + ": expected a string");
  }

  /// A list of strings, or one string.
  std::vector<std::string> words(const YamlNode& node, const std::string& key) const {
    if (node.type != YamlNode::Type::list) return {word(node, key)};
    std::vector<std::string> out;
    for (const YamlNode& item : node.list) out.push_back(word(item, key));
    return out;
  }

  std::int64_t whole(const YamlNode& node, const std::string& key, std::int64_t most) const {
    const auto* integer = std::get_if<std::int64_t>(&node.scalar);
    if (node.type == YamlNode::Type::scalar && integer != nullptr && *integer >= 1 &&
        *integer <= most) {
      return *integer;
    }
    throw input_error(
        file_, node.line, key + ": expected a whole number, 1 to " + std::to_string(most));
  }

  int count(const YamlNode& node, const std::string& key) const {
    return static_cast<int>(whole(node, key, 1'000'000));
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
    if (const YamlNode* seconds = node.find("seconds"))
      out.seconds = number(*seconds, "limits.seconds");
    if (const YamlNode* memory = node.find("memory")) {
      const std::string text = word(*memory, "limits.memory");
      const auto bytes = text == "none" ? 0 : parse_bytes(text);
      if (!bytes)
        throw input_error(file_, memory->line, "limits.memory: expected a size (2GiB) or none");
      out.memory = *bytes;
    }
    if (const YamlNode* cells = node.find("cells"))
      out.cells = whole(*cells, "limits.cells", 1'000'000'000);
    return out;
  }

  double number(const YamlNode& node,
                const std::string& key,
                const std::string& expected = "a number",
                const Between& rule = Between{0.0}) const {
    double out = 0.0;
    try {
      if (node.type != YamlNode::Type::scalar)
        throw OptionError(key, key + ": expected " + expected);
      FieldType<double>::assign(key, out, node.scalar);
      detail::check_rule(key, out, rule);
    } catch (const OptionError& error) {
      throw input_error(file_, node.line, error.what());
    }
    return out;
  }

  bool flag(const YamlNode& node, const std::string& key) const {
    const bool* value = std::get_if<bool>(&node.scalar);
    if (node.type == YamlNode::Type::scalar && value != nullptr) return *value;
    throw input_error(file_, node.line, key + ": expected true or false");
  }

  template <class Choice, class Read>
  std::vector<Choice> list(const YamlNode& root, const std::string& key, Read choices) const {
    const YamlNode* node = root.find(key);
    if (node == nullptr) throw input_error(file_, root.line, "'" + key + "' is missing");
    if (node->type != YamlNode::Type::list || node->list.empty()) {
      throw input_error(file_, node->line, key + ": expected a list with at least one entry");
    }
    std::vector<Choice> out;
    std::set<std::string> labels;
    for (const YamlNode& entry : node->list) {
      for (Choice& choice : choices(entry, file_, catalogue_)) {
        if (labels.size() == kMostChoices) {
          throw input_error(file_, entry.line, key + ": expands to more than 10000 entries");
        }
        if (!labels.insert(choice.label).second) {
          throw input_error(
              file_,
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
        throw input_error(file_, node.line, "times: expected " + choice_list<metrics::Times>());
      if (std::ranges::count(out, *value) == 0) out.push_back(*value);
    }
    if (out.empty())
      throw input_error(file_, node.line, "times: expected " + choice_list<metrics::Times>());
    return out;
  }

  std::vector<Exclusion> exclusions(const YamlNode& node) const {
    std::vector<Exclusion> out;
    if (node.type != YamlNode::Type::list) {
      throw input_error(file_, node.line, "exclude: expected a list of {dataset, method} patterns");
    }
    if (node.list.size() > kMostRules) {
      throw input_error(file_, node.line, "exclude: more than 1000 entries");
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

  std::string pattern(const YamlNode& node, const std::string& key) const {
    const std::string text = word(node, key);
    try {
      Pattern{text};
    } catch (const InputError& error) {
      throw input_error(file_, node.line, key + ": " + error.what());
    }
    return text;
  }

  TableSpec table(const YamlNode& node) const {
    map_of(node, "table", {"rows", "columns", "split", "value", "show", "where"});
    TableSpec out;
    if (const YamlNode* rows = node.find("rows")) out.rows = words(*rows, "rows");
    if (const YamlNode* columns = node.find("columns")) out.columns = words(*columns, "columns");
    if (const YamlNode* split = node.find("split")) out.split = words(*split, "split");
    if (const YamlNode* show = node.find("show")) out.show = words(*show, "show");
    if (const YamlNode* value = node.find("value")) out.value = word(*value, "value");
    if (const YamlNode* rules = node.find("where")) {
      out.where = words(*rules, "where");
      try {
        where(out.where);
      } catch (const InputError& error) {
        throw input_error(file_, rules->line, error.what());
      }
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
      throw input_error(file_, node->line, "baseline: " + unknown_name("method", name, labels));
    }
    return name;
  }

  std::string file_;
  const Catalogue& catalogue_;
};

}  // namespace

Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue) {
  Sweep sweep = SweepReader(file.string(), catalogue).read(parse_yaml(text, file.string()));
  sweep.name = file.stem().string();
  sweep.config = file;
  sweep.text = text;
  return sweep;
}

Sweep read_sweep(const std::filesystem::path& file, const Catalogue& catalogue) {
  return parse_sweep(read_named_file(file, 16'000'000, "a YAML config"), file, catalogue);
}

}  // namespace loopbench::harness
