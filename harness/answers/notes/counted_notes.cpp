#include "harness/answers/notes/counted_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "datasets/core/fields.hpp"
#include "harness/answers/notes/note_json.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/store/read.hpp"

namespace loopbench::harness {
namespace {

std::string run_name(const RunNote& one) {
  return one.sequence + (one.repeat > 0 ? fmt::format(" (repeat {})", one.repeat) : "");
}

/// What notes that are counted together share. Words of datasets and methods are not compared with
/// each other, so equal ones only.
using Key = std::tuple<std::string, NoteKind, std::string, std::string>;

Key key_of(const RunNote& one) {
  const Note& note = one.note;
  const bool is_text = note.numbers.empty();
  return {one.method,
          note.kind,
          is_text ? note.detail : note.remedy.option,
          is_text || is_of_reading(note.kind) ? note.subject : ""};
}

/// Whether a run passes the rules that are about runs and methods.
bool passes(const std::function<bool(const Record&)>& rules, const RunNote& one) {
  Record record;
  record.cell.edit().sequence = one.sequence;
  record.cell.edit().repeat = one.repeat;
  record.cell.edit().method = one.method;
  return rules(record);
}

/// The rules about fields that a run has. A note of a run is about all its methods.
std::vector<std::string> rules_of_runs(const std::vector<std::string>& rules, bool has_method) {
  std::vector<std::string> out;
  for (const std::string& rule : rules) {
    for (const std::string& part : split_rules(rule)) {
      const std::string field = field_of_rule(part);
      const bool is_kept =
          field == "sequence" || field == "repeat" || (field == "method" && has_method);
      if (is_kept) out.push_back(part);
    }
  }
  return out;
}

CountedNote counted_note(std::vector<const RunNote*> group, const StoredNotes& all) {
  CountedNote out;
  const auto first_number = [](const RunNote* one) {
    return one->note.numbers.empty() ? 0.0 : one->note.numbers.front().value;
  };
  std::set<std::pair<std::string, std::int64_t>> runs;
  std::set<std::string> sequences;
  for (const RunNote* one : group) {
    runs.emplace(one->sequence, one->repeat);
    if (sequences.insert(one->sequence).second) out.sequences.push_back(one->sequence);
  }
  std::ranges::stable_sort(group, {}, first_number);
  const RunNote& typical = *group[(group.size() - 1) / 2];
  out.note = typical.note;
  out.example = run_name(typical);
  out.method = typical.method;
  out.runs = runs.size();
  const auto of_method = all.runs_of_method.find(out.method);
  out.of = of_method == all.runs_of_method.end() ? all.runs : of_method->second;
  if (out.sequences.size() == all.sequences) out.sequences.clear();
  return out;
}

}  // namespace

std::vector<CountedNote> counted_notes(const std::filesystem::path& store,
                                       const std::vector<std::string>& rules) {
  const StoredNotes all = read_notes(store);
  const auto of_runs = where(rules_of_runs(rules, false));
  const auto of_methods = where(rules_of_runs(rules, true));
  std::vector<std::pair<Key, std::vector<const RunNote*>>> groups;
  std::map<Key, std::size_t> places;
  for (const RunNote& one : all.notes) {
    if (!passes(one.method.empty() ? of_runs : of_methods, one)) continue;
    const auto [place, is_new] = places.emplace(key_of(one), groups.size());
    if (is_new) groups.emplace_back(place->first, std::vector<const RunNote*>());
    groups[place->second].second.push_back(&one);
  }
  std::vector<CountedNote> out;
  for (auto& [key, group] : groups) out.push_back(counted_note(std::move(group), all));
  std::ranges::stable_sort(
      out, std::greater(), [](const CountedNote& each) { return each.note.severity; });
  return out;
}

std::string text(const CountedNote& own) {
  constexpr std::size_t kMost = 3;  // names of sequences
  const std::string sentence = text(own.note);
  if (own.runs == 1) {
    const std::string method = own.method.empty() ? "" : " / " + own.method;
    return own.example + method + ": " + sentence;
  }
  std::string whose = own.method.empty() ? "" : " of " + own.method;
  if (!own.sequences.empty() && own.method.empty()) {
    std::vector<std::string> names = own.sequences;
    const std::size_t more = names.size() - std::min(names.size(), kMost);
    names.resize(names.size() - more);
    whose = fmt::format(
        " ({}{})", fmt::join(names, ", "), more == 0 ? "" : fmt::format(" and {} more", more));
  }
  const std::string count = own.runs == own.of ? fmt::format("all {} runs", own.of)
                                               : fmt::format("{} of {} runs", own.runs, own.of);
  const bool varies = !own.note.numbers.empty();
  return count + whose + (varies ? ", for example " + own.example : "") + ": " + sentence;
}

std::vector<std::string> texts(const std::vector<CountedNote>& notes, Severity least) {
  std::vector<std::string> out;
  for (const CountedNote& each : notes) {
    if (each.note.severity >= least) out.push_back(text(each));
  }
  return out;
}

std::string json(const std::vector<CountedNote>& notes, int indent) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const CountedNote& each : notes) {
    nlohmann::ordered_json one = to_json(each.note);
    one["text"] = text(each);
    one["runs"] = each.runs;
    one["of"] = each.of;
    one["method"] = each.method;
    one["sequences"] = each.sequences;
    out.push_back(std::move(one));
  }
  return out.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace loopbench::harness
