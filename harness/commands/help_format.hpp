/// Layout of `--help`.
#pragma once

#include <memory>

namespace CLI {
class FormatterBase;
}

namespace loopbench::harness {

/// Fits the width of the terminal, at most 100 columns; unlimited in pipes and files. Commands
/// added after it is set use it, too.
std::shared_ptr<CLI::FormatterBase> help_formatter();

}  // namespace loopbench::harness
