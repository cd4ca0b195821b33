/// Which way a score is good.
#pragma once

#include "harness/store/record.hpp"

namespace loopbench {

/// By the metric's label, which starts with the metric's name unless a config says otherwise;
/// a label that no built-in starts with is taken for an error.
Better better(const Record& record);

}  // namespace loopbench
