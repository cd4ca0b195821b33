/// Notes as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "datasets/core/fields.hpp"
#include "harness/sweep/model/note_text.hpp"

namespace loopbench::harness {

/// {kind, severity, subject, numbers [{name, value, unit}], remedy {option, value}, detail, text}.
inline nlohmann::ordered_json to_json(const Note& note) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  for (const auto& [name, value, unit] : note.numbers) {
    numbers.push_back({{"name", name}, {"value", value}, {"unit", unit}});
  }
  return {{"kind", to_text(note.kind)},
          {"severity", to_text(note.severity)},
          {"subject", note.subject},
          {"numbers", std::move(numbers)},
          {"remedy", {{"option", note.remedy.option}, {"value", note.remedy.value}}},
          {"detail", note.detail},
          {"text", text(note)}};
}

}  // namespace loopbench::harness
