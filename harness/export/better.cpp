#include "harness/export/better.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace loopbench {

Better better(const Record& record) {
  constexpr std::array kDescriptions{std::string_view("pairs"),
                                     std::string_view("coverage"),
                                     std::string_view("diagnostics"),
                                     std::string_view("path_length"),
                                     std::string_view("jerk"),
                                     std::string_view("interpolation_floor"),
                                     std::string_view("smoothing_headroom"),
                                     std::string_view("loop_detection")};
  const auto starts = [&](std::string_view name) { return record.metric.starts_with(name); };
  if (std::ranges::any_of(kDescriptions, starts)) return Better::neither;
  return starts("gain") ? Better::higher : Better::lower;
}

}  // namespace loopbench
