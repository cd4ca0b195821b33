/// Embedded files of the report page (cmake/embed.cmake generates the definition).
#pragma once

#include <string_view>
#include <vector>

namespace loopbench::harness {

struct Asset {
  std::string_view name;  ///< "page/report.css": path relative to harness/answers/report
  std::string_view text;
};

/// Sorted by name within page/ and assets/.
const std::vector<Asset>& assets();

}  // namespace loopbench::harness
