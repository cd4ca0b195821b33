/// A table of strings.
#pragma once

#include <string>
#include <vector>

#include "harness/tables/table_view.hpp"

namespace loopbench::harness {

struct TextTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as columns
  std::vector<std::string> notes;
};

/// Padded for reading on a terminal; the first column is left-aligned, the others right-aligned.
/// Pipes are escaped.
std::string markdown(const TextTable& listing);

/// The same without marks, for terminal().
TableView table_view(const TextTable& listing);

/// RFC 4180, with the title as first column.
std::string csv(const TextTable& listing);

}  // namespace loopbench::harness
