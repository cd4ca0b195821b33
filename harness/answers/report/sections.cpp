#include "harness/answers/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "harness/answers/tables/pivot.hpp"

namespace loopbench::harness {
namespace {

std::string counter(std::size_t number, const std::string& what, const std::string& kind = "") {
  return fmt::format("<div class=\"counter {}\"><b>{}</b> {}</div>", kind, number, html_text(what));
}

std::string plural(std::size_t number, const std::string& one) {
  return number == 1 ? one : one + "s";
}

/// Times are shown next to the names, so that they need no scrolling.
bool is_shown_first(const Record& r) { return r.kind->metric == "time"; }

}  // namespace

std::string summary_html(const ReportContent& content) {
  std::map<Status, std::size_t> statuses;
  std::set<std::int64_t> repeats;
  for (const CellRow& cell : content.cells) {
    ++statuses[cell.status];
    repeats.insert(cell.repeat);
  }
  std::string out =
      "<div class=\"counters\">" +
      counter(content.methods.size(), plural(content.methods.size(), words_of(content).one)) +
      counter(content.sequences.size(), plural(content.sequences.size(), "sequence")) +
      counter(repeats.size(), plural(repeats.size(), "repeat"));
  for (const auto& [status, number] : statuses) {
    const bool is_bad = is_failure(status);
    out += counter(number,
                   plural(number, words_of(content).cell) + " " + to_text(status),
                   is_bad ? "bad" : "");
  }
  out += "</div>\n";
  if (content.shown == content.sequences.size()) return out;
  return out + fmt::format(
                   "<p class=\"warning\">Tables by sequence and figures show the first {} of {} "
                   "sequences, because the size of the report is limited (--size). Verdicts, costs "
                   "and failures cover all.</p>\n",
                   content.shown,
                   content.sequences.size());
}

std::string notes_html(const ReportContent& content, Severity least) {
  const std::vector<std::string> lines = texts(content.notes, least);
  if (lines.empty()) return "";
  std::string out = "<ul class=\"notes\">";
  for (const std::string& line : lines) out += "<li>" + html_text(line) + "</li>";
  return out + "</ul>\n";
}

std::string scores_html(const ReportContent& content) {
  std::string out;
  std::map<SharedText, std::vector<Record>> by_sequence;
  for (const bool first : {true, false}) {
    for (const Record& r : content.records) {
      if (is_shown_first(r) == first) by_sequence[r.cell->sequence].push_back(r);
    }
  }
  const auto part = [&](const std::string& sequence, const std::string& times) {
    std::vector<Record> records;
    for (const Record& r : by_sequence[sequence]) {
      if (r.kind->times == times || !r.has_score()) records.push_back(r);
    }
    if (std::ranges::all_of(records, [](const Record& r) { return !r.has_score(); })) return;
    for (Table& table : pivot(records, TableSpec{})) {
      if (table.headings.front() == "method") table.headings.front() = words_of(content).one;
      out += html_table(
          table, "data-sequence=\"" + html_text(sequence) + "\" data-times=\"" + times + "\"");
    }
  };
  for (const std::string& sequence : content.shown_sequences()) {
    part(sequence, "keyframes");
    part(sequence, "dense");
  }
  return out.empty() ? fmt::format("<p>No {} has scores.</p>\n", words_of(content).cell) : out;
}

std::string provenance_html(const ReportContent& content) {
  std::string out;
  out += "<h3>Protocol of every number</h3>\n<pre tabindex=\"0\">" +
         html_text(content.run_value("protocol")) + "</pre>\n";
  Table provenance{"provenance", {"item", "value"}, {}, {}};
  for (const auto& [key, value] : content.provenance) provenance.lines.push_back({key, value});
  out += html_text_table(provenance);
  if (!content.inputs.empty()) {
    Table files{"input files", {"sequence", "file", "bytes", "XXH3 128"}, {}, {}};
    for (const auto& [sequence, inputs] : content.inputs) {
      for (const InputFile& input : inputs) {
        files.lines.push_back({sequence, input.path, std::to_string(input.bytes), input.hash});
      }
    }
    out += html_text_table(files);
  }
  const std::string notes = notes_html(content, Severity::info);
  if (!notes.empty()) out += "<h3>Notes</h3>\n" + notes;
  return out + "<h3>Config</h3>\n<pre tabindex=\"0\">" + html_text(content.run_value("config")) +
         "</pre>\n";
}

}  // namespace loopbench::harness
