/// Static HTML of a report: text, tables and sections.
#pragma once

#include <string>
#include <string_view>

#include "harness/answers/report/report.hpp"
#include "harness/answers/tables/table.hpp"

namespace loopbench::harness {

/// For element content and quoted attributes: & < > " ' replaced, control characters dropped.
std::string html_text(std::string_view text);

/// JSON for a <script> element, with every `<` escaped, so that no content can end the element.
std::string script_text(const std::string& json);

/// A table with its caption and a list of notes. `attributes` is inserted into the figure's tag.
std::string html_table(const Table& table, const std::string& attributes = "");

/// The same for columns of words instead of numbers.
std::string html_text_table(const Table& table);

/// Number of cells by status.
std::string summary_html(const ReportContent& content);

/// Notes of at least this severity, as a list; empty if there are none.
std::string notes_html(const ReportContent& content, Severity least);

/// The notes that can change a conclusion, and the verdict of each score: sentence, a table of all
/// methods, the best first, cautions, limits; all but the headline are hidden. Without a verdict,
/// all methods with their mean error.
std::string answers_html(const ReportContent& content);

/// Methods by scores, a table for each sequence, times and protocol.
std::string scores_html(const ReportContent& content);

/// Failed cells and undefined scores, by reason.
std::string failures_html(const ReportContent& content);

/// Costs, and values reported by the methods.
std::string costs_html(const ReportContent& content);

/// One row per method: wall and CPU time, memory, iterations. Medians over its finished cells,
/// maximum for memory. No rows for results of files (`eval --store`), which have no times.
Table costs(const std::vector<CellRow>& cells);

/// Protocols, provenance, input files, config.
std::string provenance_html(const ReportContent& content);

}  // namespace loopbench::harness
