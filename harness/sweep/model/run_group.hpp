/// What the group of a run is, whose runs are not independent of each other.
#pragma once

#include <array>
#include <utility>

namespace loopbench::harness {

enum class GroupKind {
  none,    ///< the run is a group of its own
  source,  ///< runs of one recording, or with one noise
  named,   ///< runs with the same `group` in a config
  files    ///< the files of one run on a recording; its other runs are independent
};
inline auto choices(GroupKind) {
  return std::array{std::pair{"none", GroupKind::none},
                    std::pair{"source", GroupKind::source},
                    std::pair{"named", GroupKind::named},
                    std::pair{"files", GroupKind::files}};
}

}  // namespace loopbench::harness
