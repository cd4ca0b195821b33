/// Embedded templates of pages, and their placeholders.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace loopbench::harness {

using Placeholders = std::map<std::string, std::string, std::less<>>;

/// The text of an embedded file, "page/report.css". Throws std::logic_error if there is none.
std::string asset_text(std::string_view name);

/// Replaces every {{name}} of the template in one pass; inserted text is not searched again. Throws
/// std::logic_error for a placeholder without a value.
std::string filled(std::string_view page, const Placeholders& values);

}  // namespace loopbench::harness
