/// Contents of a report, read from a store.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/store/read.hpp"

namespace loopbench::harness {

struct ReportContent {
  std::filesystem::path store;
  std::map<std::string, std::string> run;
  std::map<std::string, std::string> provenance;
  std::map<std::string, std::vector<InputFile>> inputs;
  std::vector<CellRecord> cells;
  std::vector<Record> records;          ///< including gains, pair counts and times
  std::vector<Comparison> comparisons;  ///< one for each score; empty without a baseline
  std::vector<std::string> sequences;   ///< labels in the order of the sweep
  std::vector<std::string> methods;     ///< likewise

  /// The headline comparison of the summary: position ATE under the first protocol, dense if
  /// available, otherwise the first comparison. Null if none compares two methods.
  const Comparison* headline() const;
};

/// Throws InputError if it is not a store, or a store without cells.
ReportContent read_report_content(const std::filesystem::path& store);

}  // namespace loopbench::harness
