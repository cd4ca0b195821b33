#include "harness/sweep/store/note_rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "datasets/core/fields.hpp"

namespace loopbench::harness {
namespace {

std::string quoted_json(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

std::vector<Quantity> numbers_of(Database& database, const std::string& json) {
  std::vector<Quantity> out;
  if (json == "[]") return out;
  Statement row = database.prepare(
      "SELECT json_extract(value, '$.name'), json_extract(value, '$.value'), "
      "json_extract(value, '$.unit') FROM json_each(?)");
  row.bind(json);
  while (row.step()) {
    Quantity& number = out.emplace_back();
    std::optional<double> value;
    row.read(number.name, value, number.unit);
    number.value = value.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

}  // namespace

std::string numbers_json(const Note& note) {
  std::string out = "[";
  for (const auto& [name, value, unit] : note.numbers) {
    out += fmt::format("{}{{\"name\": {}, \"value\": {}, \"unit\": {}}}",
                       out.size() > 1 ? ", " : "",
                       quoted_json(name),
                       std::isfinite(value) ? fmt::to_string(value) : "null",
                       quoted_json(unit));
  }
  return out + "]";
}

Note read_note(Database& database, Statement& row) {
  Note out;
  std::string kind, severity, numbers;
  row.read(kind, severity, out.subject, numbers, out.remedy.option, out.remedy.value, out.detail);
  out.kind = from_text<NoteKind>(kind).value_or(NoteKind::dataset);
  out.severity = from_text<Severity>(severity).value_or(Severity::info);
  out.numbers = numbers_of(database, numbers);
  return out;
}

}  // namespace loopbench::harness
