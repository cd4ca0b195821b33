/// Options that hold text get a scalar as it was written: `label: 00`, `estimate: 007`, `name:
/// 1e3`.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "datasets/core/params.hpp"
#include "harness/config/grid.hpp"

namespace loopbench {

/// The value that `option` is given, where `text` is how it was written (empty: nobody wrote it).
inline Param value_for(const OptionInfo& option, const Param& value, const std::string& text) {
  return option.is_text && !text.empty() ? Param(text) : value;
}

/// Replaces the values of text options; unknown names are left to the check of the options.
inline void keep_text(std::vector<Setting>& settings, const std::vector<OptionInfo>& options) {
  for (Setting& setting : settings) {
    const auto option = std::ranges::find(options, setting.name, &OptionInfo::name);
    if (option != options.end()) setting.value = value_for(*option, setting.value, setting.text);
  }
}

}  // namespace loopbench
