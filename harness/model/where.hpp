/// Which records to keep, as typed by people.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// The parts of a list: at commas outside of brackets and of quotes, which are taken off. Throws
/// InputError for a quote that is not closed.
std::vector<std::string> split_list(const std::string& text);

/// Each rule is `field=text`, `field!=text` or `field~regex` (a Pattern, found anywhere), or
/// several of them separated by commas outside of brackets and of quotes around a text
/// (`method="a, b"`); all must hold. Fields are those of `field` in record.hpp; `metric` holds for
/// a metric's name and for its label. A cell that left no score passes rules about fields it does
/// not have: its reason belongs into every table. Throws InputError naming the rule.
std::function<bool(const Record&)> where(const std::vector<std::string>& rules);

/// Drops the records that `where` does not keep.
void keep_where(std::vector<Record>& records, const std::vector<std::string>& rules);

}  // namespace loopbench
