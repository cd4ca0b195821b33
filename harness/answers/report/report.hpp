/// HTML report of a sweep in one self-contained file, and its contents.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/answers/compare/compare.hpp"
#include "harness/answers/notes/counted_notes.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"

namespace loopbench::harness {

inline constexpr std::size_t kReportBytes = 9'000'000;  ///< default size limit

struct ReportContent {
  std::filesystem::path store;
  std::map<std::string, std::string> run;
  std::map<std::string, std::string> provenance;
  std::map<std::string, std::vector<InputFile>> inputs;
  std::vector<CellRow> cells;
  std::vector<CountedNote> notes;       ///< the most severe first
  std::vector<Comparison> comparisons;  ///< one for each score; empty without a baseline
  std::vector<Record> undefined;        ///< scores without a value, or of incomplete estimates
  std::vector<std::string> sequences;   ///< labels in the order of the sweep
  std::vector<std::string> methods;     ///< likewise

  /// Tables by sequence and figures are of the first sequences, as many as a report can hold.
  std::size_t shown = 0;
  std::vector<CellRow> shown_cells;
  std::vector<Record> records;  ///< of shown cells, including gains, pair counts and times

  std::span<const std::string> shown_sequences() const { return std::span(sequences).first(shown); }

  /// Of `run`; empty if it has none.
  std::string run_value(const std::string& key) const;

  /// Reduces `shown`.
  void show(std::size_t sequences);

  /// The headline comparison of the summary: position ATE under the first protocol, dense if
  /// available, otherwise the first comparison. Null if none compares two methods.
  const Comparison* headline() const;
};

/// What a page calls the things it compares.
struct ReportWords {
  const char* one = "method";
  const char* cell = "cell";
  const char* cells = "cells";
};

/// Of evaluated files: estimates, and evaluations.
ReportWords words_of(const ReportContent& content);

/// Shows as many sequences as could fit into `bytes`. The memory is bounded by `bytes`, the number
/// of cells (about 600 bytes each) and the number of compared values (32 bytes each). Throws
/// InputError if it is not a store, or a store without cells.
ReportContent read_report_content(const std::filesystem::path& store,
                                  std::size_t bytes = kReportBytes);

/// The methods whose trajectories `plot` and the report draw by default: the baseline, the best one
/// and, if some are chains of a corrector and a smoother, the best one without a smoother; if none
/// are chains, the best ones, at most five in all. Without a ranking the first methods of the
/// sweep.
std::vector<std::string> default_methods(const ReportContent& content);

/// All methods, the baseline first, then in the order of the sweep; if there are more methods than
/// colours, default_methods() first. Their indices determine their styles (curve_style()) in `plot`
/// and in the report.
std::vector<std::string> style_order(const ReportContent& content);

/// Tables and verdicts are plain HTML; figures are drawn from embedded data by the page's scripts
/// (d3, embedded). Until the file is smaller than `bytes`, trajectories of later repeats are left
/// out, then curves are coarser; then later sequences are left out of tables and figures, which the
/// summary says. Throws InputError naming the minimum size if one sequence is too large.
std::string report_html(ReportContent content, std::size_t bytes = kReportBytes);

}  // namespace loopbench::harness
