/// The files of a report's page, carried in the program (cmake/embed.cmake writes the definition).
#pragma once

#include <string_view>
#include <vector>

namespace loopbench {

struct Asset {
  std::string_view name;  ///< "page/report.css": its path below harness/report
  std::string_view text;
};

/// In the order of their names within page/ and assets/.
const std::vector<Asset>& assets();

}  // namespace loopbench
