#include "datasets/formats/format_registry.hpp"

#include <algorithm>
#include <array>

#include "datasets/core/fields.hpp"

namespace loopbench {

std::span<const FormatEntry> formats() {
  static const std::array all{frames_format(),
                              bag_format(),
                              npy_format(),
                              json_format(),
                              g2o_format(),
                              json_graph_format(),
                              log_format(),
                              kitti_format(),
                              euroc_format(),
                              tum_format(),
                              csv_format()};
  return all;
}

const FormatEntry& entry_of(Format format) {
  const auto all = formats();
  const auto found = std::ranges::find(all, format, &FormatEntry::format);
  if (found == all.end()) throw InputError("format: found " + to_text(format));
  return *found;
}

}  // namespace loopbench
