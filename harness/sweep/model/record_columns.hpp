/// The columns of `table --rows`, `--columns`, `--split` and `--where`, beside options of methods:
/// a line adds one.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

struct RecordColumn {
  const char* name;
  std::string (*text)(const Record&);
  bool is_of_cell = false;  ///< not of the score
};

template <std::string ScoreKind::*text>
std::string text_of_kind(const Record& record) {
  return (*record.kind).*text;
}

inline constexpr RecordColumn kRecordColumns[] = {
    {"sequence", [](const Record& r) -> std::string { return r.cell->sequence; }, true},
    {"repeat", [](const Record& r) { return std::to_string(r.cell->repeat); }, true},
    {"method", [](const Record& r) -> std::string { return r.cell->method; }, true},
    {"closures", [](const Record& r) -> std::string { return r.cell->closures; }, true},
    {"protocol", text_of_kind<&ScoreKind::protocol>},
    {"protocol_version", text_of_kind<&ScoreKind::protocol_version>},
    {"times", text_of_kind<&ScoreKind::times>},
    {"metric", text_of_kind<&ScoreKind::metric>},
    {"label", [](const Record& r) { return r.kind->metric_label(); }},
    {"relation", text_of_kind<&ScoreKind::relation>},
    {"axis", text_of_kind<&ScoreKind::axis>},
    {"unit", text_of_kind<&ScoreKind::unit>},
    {"status", [](const Record& r) { return std::string(to_text(r.status)); }, true},
    {"score", [](const Record& r) { return r.kind->short_name(); }}};

/// Their names in that order.
std::vector<std::string> record_columns();

}  // namespace loopbench::harness
