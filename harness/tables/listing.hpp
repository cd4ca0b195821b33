/// A table of texts.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

struct Listing {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as columns
  std::vector<std::string> notes;
};

/// Padded, so that it reads on a terminal too; the first column to the left, the others to the
/// right. Pipes are escaped.
std::string markdown(const Listing& listing);

/// RFC 4180, the title as first column.
std::string csv(const Listing& listing);

}  // namespace loopbench
