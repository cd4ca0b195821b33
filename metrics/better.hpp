/// The direction in which a score improves.
#pragma once

#include <array>
#include <utility>

namespace loopbench::metrics {

enum class Better {
  lower,    ///< errors and times
  higher,   ///< gains
  target,   ///< best at a stated value, for example a ratio at 1
  neither,  ///< descriptions: counts, coverage, diagnostics, estimated coordinates
};
inline auto choices(Better) {
  return std::array{std::pair{"lower", Better::lower},
                    std::pair{"higher", Better::higher},
                    std::pair{"target", Better::target},
                    std::pair{"neither", Better::neither}};
}

}  // namespace loopbench::metrics
