/// What a report tells, read from a store.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/store/read.hpp"

namespace loopbench {

struct ReportContent {
  std::filesystem::path store;
  std::map<std::string, std::string> run;
  std::map<std::string, std::string> provenance;
  std::map<std::string, std::vector<InputFile>> inputs;
  std::vector<CellRecord> cells;
  std::vector<Record> records;          ///< gains, pair counts and times included
  std::vector<Comparison> comparisons;  ///< one for each score; empty without a baseline
  std::vector<std::string> sequences;   ///< labels in the order of the sweep
  std::vector<std::string> methods;     ///< likewise

  /// The comparison a summary starts with: ATE of positions under the first protocol, dense where
  /// there is dense, else whatever comes first. Null when none compares two methods.
  const Comparison* headline() const;
};

/// Throws InputError when it is not a store, or one without cells.
ReportContent read_report_content(const std::filesystem::path& store);

}  // namespace loopbench
