/// Notes as rows of a store.
#pragma once

#include <string>

#include "harness/sweep/model/note.hpp"
#include "harness/sweep/store/sqlite.hpp"

namespace loopbench::harness {

/// Selects the columns that read_note() reads.
inline constexpr const char* kNoteColumns =
    "kind, severity, subject, numbers, remedy_option, remedy_value, detail";

/// The numbers as JSON, for columns of stores: [{"name": "bias", "value": 5.1, "unit": "%"}].
std::string numbers_json(const Note& note);

/// Reads the columns kNoteColumns of the current row. `database`: for parsing its JSON.
Note read_note(Database& database, Statement& row);

/// Binds the columns from `text` on. `bind(values...)` is called once.
template <class Bind>
void bind_note(const Note& note, const std::string& text, Bind bind) {
  bind(text,
       to_text(note.kind),
       to_text(note.severity),
       note.subject,
       numbers_json(note),
       note.remedy.option,
       note.remedy.value,
       note.detail);
}

}  // namespace loopbench::harness
