/// Text from files and command lines, safe to show on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace loopbench {

/// Newlines and UTF-8 stay; other control characters (C0, DEL, C1) and bytes that are no UTF-8
/// become "\x1b": a file must not be able to steer the terminal that its name or text is shown on.
std::string printable(std::string_view text);

}  // namespace loopbench
