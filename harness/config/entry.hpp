/// Entries of a config's lists, and the same in one word of the command line.
#pragma once

#include <string>
#include <vector>

#include "harness/config/grid.hpp"

namespace loopbench::harness {

/// A name, an optional label and options; a grid of options has several points, at least one.
struct ConfigEntry {
  Place place;
  std::string name;
  std::string label;  ///< empty: none
  std::vector<GridPoint> points;
};

/// Reads `NAME`, or a map with `key: NAME`, `label: TEXT` and options. Keys in `reserved` are no
/// options. Throws InputError `file:line:`.
ConfigEntry read_entry(const YamlNode& node,
                       const std::string& key,
                       const std::vector<std::string>& reserved = {});

/// Parses `NAME:option=value,option=value`, whose label is the complete text. Stages are separated
/// by `+`; in a text with several, the name of an option starts with that of its stage. Values can
/// be quoted. `where` is the option of the command line. Throws InputError.
ConfigEntry parse_entry(const std::string& text, const std::string& where);

/// Parses `option=value`.
Setting parse_setting(const std::string& text, const std::string& where);

/// The values of `--set NAME=VALUE`, whose names and ranges are checked by whoever applies them.
/// Throws InputError.
Params parse_settings(const std::vector<std::string>& texts,
                      const std::vector<OptionInfo>& options);

/// Replaces the values of text options by the scalars as written: `label: 00`, `estimate: 007`,
/// `name: 1e3`. The option check reports unknown names.
void restore_text_options(std::vector<Setting>& settings, const std::vector<OptionInfo>& options);

Params to_params(const std::vector<Setting>& settings);

/// The names between the plus signs of "uniform + dm_n4", trimmed.
std::vector<std::string> split_stages(const std::string& text);

}  // namespace loopbench::harness
