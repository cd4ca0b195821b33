/// Texts and tables as HTML.
#pragma once

#include <string>
#include <string_view>

#include "harness/tables/listing.hpp"
#include "harness/tables/sheet.hpp"

namespace loopbench {

/// For element content and quoted attributes: & < > " ' replaced, control characters dropped.
std::string html_text(std::string_view text);

/// JSON for a <script> element: no `<` is left, so that nothing in it can end the element.
std::string script_text(std::string json);

/// A table with its caption; notes in a list below. `attributes` stands in the figure's tag as is.
std::string html_table(const Sheet& sheet, const std::string& attributes = "");
std::string html_table(const Listing& listing);

/// Likewise for columns of words rather than numbers.
std::string html_text_table(const Listing& listing);

}  // namespace loopbench
