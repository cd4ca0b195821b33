/// Reads single settings of a config and collects their errors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/config/yaml.hpp"

namespace loopbench::harness {

/// The errors of a config, one per line. Not an InputError, so that `attempt` does not collect it.
struct CollectedErrors {
  std::string text;
};

/// Messages name the file. The functions throw InputError `file:line:` for another type or value.
class SettingReader {
 public:
  explicit SettingReader(std::string file) : file_(std::move(file)) {}

 protected:
  static constexpr std::size_t kMostErrors = 10;  // reported at once

  /// Collects the InputError of `read`, if any. Throws CollectedErrors for the tenth.
  template <class Read>
  void attempt(Read read) const {
    try {
      read();
    } catch (const InputError& error) {
      collect(error.what());
    }
  }

  /// Reads the setting `key`, if it is there.
  template <class Read>
  void optional(const YamlNode& root, const std::string& key, Read read) const {
    if (const YamlNode* node = root.find(key)) attempt([&] { read(*node); });
  }

  bool has_errors() const { return !errors_.empty(); }

  /// Throws CollectedErrors if there are any.
  void report_errors(const std::string& end = "") const;

  /// Settings for which only a map with the `known` keys is accepted.
  void map_of(const YamlNode& node,
              const std::string& key,
              const std::vector<std::string>& known) const;

  /// Collects an error for each unknown key.
  void only_keys(const YamlNode& node, const std::vector<std::string>& known) const;

  std::string word(const YamlNode& node, const std::string& key) const;
  /// A list of strings, or one string.
  std::vector<std::string> words(const YamlNode& node, const std::string& key) const;
  /// From 1 to `most`.
  std::int64_t integer(const YamlNode& node, const std::string& key, std::int64_t most) const;
  int count(const YamlNode& node, const std::string& key) const;
  double number(const YamlNode& node,
                const std::string& key,
                const std::string& expected = "a number",
                const Between& rule = Between{0.0}) const;
  bool flag(const YamlNode& node, const std::string& key) const;
  /// A regular expression.
  std::string pattern(const YamlNode& node, const std::string& key) const;

  const std::string& file() const { return file_; }

 private:
  void collect(const std::string& error) const;

  std::string file_;
  mutable std::vector<std::string> errors_;  // found so far
};

}  // namespace loopbench::harness
