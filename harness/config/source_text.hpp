/// Options of type text take the scalar as written: `label: 00`, `estimate: 007`, `name: 1e3`.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "datasets/core/params.hpp"
#include "harness/config/entry.hpp"

namespace loopbench::harness {

/// The value for `option`, where `text` is the scalar as written (empty: computed).
inline Param value_for(const OptionInfo& option, const Param& value, const std::string& text) {
  return option.is_text && !text.empty() ? Param(text) : value;
}

/// Replaces the values of text options; the option check reports unknown names.
inline void restore_text_options(std::vector<Setting>& settings,
                                 const std::vector<OptionInfo>& options) {
  for (Setting& setting : settings) {
    const auto option = std::ranges::find(options, setting.name, &OptionInfo::name);
    if (option != options.end()) setting.value = value_for(*option, setting.value, setting.text);
  }
}

inline Params to_params(const std::vector<Setting>& settings) {
  Params out;
  for (const Setting& setting : settings) out[setting.name] = setting.value;
  return out;
}

/// The values of `--set NAME=VALUE`, whose names and ranges are checked by whoever applies them.
/// Throws InputError.
inline Params parse_settings(const std::vector<std::string>& texts,
                             const std::vector<OptionInfo>& options) {
  std::vector<Setting> out;
  for (const std::string& text : texts) {
    out.push_back(parse_setting(text, "--set"));
    const double* const real = std::get_if<double>(&out.back().value);
    if (real != nullptr && !std::isfinite(*real)) {
      throw InputError("--set: " + text + ": expected a finite number");
    }
  }
  restore_text_options(out, options);
  return to_params(out);
}

}  // namespace loopbench::harness
