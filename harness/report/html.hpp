/// Conversion of text and tables to HTML.
#pragma once

#include <string>
#include <string_view>

#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// For element content and quoted attributes: & < > " ' replaced, control characters dropped.
std::string html_text(std::string_view text);

/// JSON for a <script> element, with every `<` escaped, so that no content can end the element.
std::string script_text(const std::string& json);

/// A table with its caption and a list of notes. `attributes` is inserted into the figure's tag.
std::string html_table(const Table& table, const std::string& attributes = "");

/// The same for columns of words instead of numbers.
std::string html_text_table(const Table& table);

}  // namespace loopbench::harness
