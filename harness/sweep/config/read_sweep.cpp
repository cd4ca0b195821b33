#include "harness/sweep/config/read_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "datasets/compressed/input_file.hpp"
#include "harness/sweep/config/choices.hpp"
#include "harness/sweep/config/keys.hpp"
#include "harness/sweep/config/sweep_settings.hpp"
#include "harness/sweep/config/values.hpp"
#include "harness/sweep/text/pattern.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLongestConfig = 16'000'000;  // [bytes]

/// Most datasets, methods and metrics: far above real sweeps, so that a few lines cannot request
/// hours.
constexpr std::size_t kMostChoices = 10'000;

/// Errors of a config, one per line, to be reported together.
class Errors {
 public:
  explicit Errors(std::string file) : file_(std::move(file)) {}

  /// Keeps the InputError of `read`, if any. Throws all errors after the tenth.
  template <class Read>
  void attempt(Read read) {
    if (is_full_) return;
    try {
      read();
    } catch (const InputError& error) {
      add(error.what());
    }
  }

  void add(const std::string& error) {
    if (is_full_ || std::ranges::count(errors_, error) > 0) return;  // an alias repeats it
    errors_.push_back(error);
    is_full_ = errors_.size() == kMost;
    if (is_full_) errors_.push_back(file_ + ": reading stopped after ten errors");
  }

  bool empty() const { return errors_.empty(); }

  void report() const {
    if (!empty()) throw InputError(fmt::format("{}", fmt::join(errors_, "\n")));
  }

 private:
  static constexpr std::size_t kMost = 10;

  std::string file_;
  std::vector<std::string> errors_;
  bool is_full_ = false;
};

/// The choices of all entries of the list `key`. Labels must differ.
template <class Choice, class Read>
std::vector<Choice> list(const YamlNode& root, const std::string& key, Errors& errors, Read read) {
  const YamlNode* node = root.find(key);
  if (node == nullptr) throw root.error("'" + key + "' is missing");
  if (node->type != YamlNode::Type::list || node->list.empty()) {
    throw node->error(key + ": expected a list with at least one entry");
  }
  std::vector<Choice> out;
  std::set<std::string> labels;
  for (const YamlNode& entry : node->list) {
    std::vector<Choice> expanded;
    errors.attempt([&] { expanded = read(entry); });
    for (Choice& choice : expanded) {
      if (labels.size() == kMostChoices) {
        throw entry.error(key + ": expands to more than 10000 entries");
      }
      if (!labels.insert(choice.label).second) {
        throw entry.error("two entries of " + key + " have the label '" + choice.label +
                          "'; set label in one");
      }
      out.push_back(std::move(choice));
    }
  }
  return out;
}

/// Throws unless the pattern matches a label: it is misspelt, and its cells would be computed.
template <class Choice>
void require_match(const YamlNode& entry, const char* key, const std::vector<Choice>& choices) {
  const YamlNode* const node = entry.find(key);
  if (node == nullptr) return;
  const Pattern pattern(node->text);
  const auto is_matched = [&](const Choice& choice) { return pattern.matches(choice.label); };
  if (std::ranges::any_of(choices, is_matched)) return;
  throw node->error(
      fmt::format("exclude: the label of no {} matches '{}' (a regular expression for "
                  "the complete label)",
                  key,
                  node->text));
}

/// The label of the given method, or of a default one; empty: none.
std::string baseline(const YamlNode* node, const std::vector<MethodChoice>& methods) {
  std::vector<std::string> labels;
  for (const MethodChoice& method : methods) labels.push_back(method.label);
  if (node == nullptr) {
    for (const char* each : {"raw", "raw + polyline", "polyline"}) {
      if (std::ranges::count(labels, each) > 0) return each;
    }
    return "";
  }
  const std::string name = as_text(*node, "baseline");
  if (std::ranges::count(labels, name) > 0) return name;
  throw node->error("baseline: " + unknown_name("method", name, labels));
}

/// Throws one InputError with up to ten errors.
Sweep read_root(const YamlNode& root, const Catalogue& catalogue, const Folders& folders) {
  if (root.type != YamlNode::Type::map) {
    throw root.error("expected a map with datasets, methods and metrics");
  }
  Sweep sweep;
  Errors errors(*root.file);
  for (const InputError& error : unknown_keys(root, config_key_names(""))) errors.add(error.what());
  errors.attempt([&] {
    sweep.datasets = list<DatasetChoice>(root, "datasets", errors, [&](const YamlNode& entry) {
      return read_datasets(entry, catalogue, folders);
    });
  });
  errors.attempt([&] {
    sweep.methods = list<MethodChoice>(root, "methods", errors, [&](const YamlNode& entry) {
      return method_choices(read_entry(entry, "method"), catalogue);
    });
  });
  const auto optional = [&](const std::string& key, auto& out, auto as) {
    errors.attempt([&] { read_key(root, key, out, as); });
  };
  optional("protocol", sweep.protocols, [](const YamlNode& node, const std::string&) {
    return protocol_choices(node);
  });
  errors.attempt([&] {
    sweep.metrics = list<MetricChoice>(root, "metrics", errors, [&](const YamlNode& entry) {
      return metric_choices(read_entry(entry, "metric"), catalogue, sweep.protocols);
    });
  });
  std::vector<std::string> plugins;  // loaded before, see with_config_plugins()
  std::string description;
  optional("times", sweep.times, as_times);
  optional("plugins", plugins, as_texts);
  optional("description", description, as_text);
  optional("min_coverage", sweep.min_coverage, [](const YamlNode& node, const std::string& key) {
    return as_number(node, key, Between{0.0, 1.0});
  });
  optional("repeats", sweep.repeats, as_count);
  errors.attempt([&] {
    if (const YamlNode* node = root.find("timing")) read_timing(*node, sweep);
  });
  optional("limits", sweep.limits, as_limits);
  optional("traces", sweep.traces, as_flag);
  optional("exclude", sweep.exclude, as_exclusions);
  optional("table", sweep.table, as_table);
  errors.report();  // because the labels of rejected methods are missing below
  errors.attempt([&] { sweep.baseline = baseline(root.find("baseline"), sweep.methods); });
  errors.attempt([&] {
    const YamlNode* exclude = root.find("exclude");
    for (std::size_t i = 0; i < sweep.exclude.size(); ++i) {
      require_match(exclude->list[i], "dataset", sweep.datasets);
      require_match(exclude->list[i], "method", sweep.methods);
    }
  });
  errors.report();
  return sweep;
}

}  // namespace

Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue,
                  const std::filesystem::path& data) {
  Folders folders{file.parent_path().empty() ? "." : file.parent_path()};
  if (!data.empty()) folders.push_back(data);
  Sweep sweep = read_root(parse_yaml(text, file.string()), catalogue, folders);
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
  std::vector<std::string> listed;
  try {
    listed = as_texts(*node, "plugins");
  } catch (const InputError&) {
    return given;  // see read_sweep()
  }
  for (const std::string& text : listed) {
    const std::filesystem::path plugin = file.parent_path() / text;
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
