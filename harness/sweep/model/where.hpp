/// Filter of records.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Splits a list at commas outside brackets and quotes, and removes the quotes. Throws InputError
/// for a missing closing quote.
std::vector<std::string> split_list(const std::string& text);

/// The single rules of a comma-separated list of them, quotes kept. Throws likewise.
std::vector<std::string> split_rules(const std::string& rule);

/// The field of a single rule; the complete text without an operator.
std::string field_of_rule(const std::string& rule);

/// Each rule is `field=text`, `field!=text` or `field~regex` (a Pattern, found anywhere), or a
/// comma-separated list of them, with quotes around texts with commas (`method="a, b"`); all must
/// hold. Fields are those of `field` in record.hpp; `metric` matches a metric's name or label. A
/// cell without scores passes rules about fields that it does not have, so that every table shows
/// its reason. Throws InputError naming the rule.
std::function<bool(const Record&)> where(const std::vector<std::string>& rules);

/// Drops the records that `where` rejects.
void keep_where(std::vector<Record>& records, const std::vector<std::string>& rules);

}  // namespace loopbench::harness
