/// Tables as text.
#pragma once

#include <string>
#include <vector>

#include "harness/export/pivot.hpp"

namespace loopbench {

/// A number with the decimals its column needs: four significant ones for the largest.
int decimals(double largest);

/// A CSV field, in quotes where it needs them (RFC 4180).
std::string quoted(const std::string& text);

/// GitHub Markdown with padded columns, so that it reads on a terminal too. Pipes are escaped.
std::string markdown(const Table& table);
std::string markdown(const std::vector<Table>& tables);

/// One CSV with the split columns first (RFC 4180 quoting), numbers in full precision.
std::string csv(const std::vector<Table>& tables);

/// The long table: a line per record with every column.
std::string csv(const std::vector<Record>& records);

}  // namespace loopbench
