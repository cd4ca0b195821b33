#include "harness/sweep/model/where.hpp"

#include <algorithm>
#include <optional>

#include "datasets/core/error.hpp"
#include "harness/sweep/text/pattern.hpp"

namespace loopbench::harness {
namespace {

struct Condition {
  std::string field;
  std::string text;
  bool is_wanted = true;  // false: field!=text
  std::optional<Pattern> pattern;
};

/// Splits at commas outside brackets and quotes: labels such as `evo (align=se3, first=10)` are
/// kept together. A quote opens only at the beginning of a part or after an operator.
std::vector<std::string> split(const std::string& rule) {
  std::vector<std::string> parts{""};
  int depth = 0;
  bool is_quoted = false;
  for (const char c : rule) {
    std::string& part = parts.back();
    const bool can_open = part.empty() || part.back() == '=' || part.back() == '~';
    if (c == '"' && (is_quoted || can_open)) is_quoted = !is_quoted;
    if (is_quoted) {
      part += c;
      continue;
    }
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c == ',' && depth <= 0) {
      parts.emplace_back();
    } else {
      part += c;
    }
  }
  if (is_quoted) throw InputError("'" + rule + "': missing closing quote");
  return parts;
}

std::string unquoted(const std::string& text) {
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

Condition condition(const std::string& part) {
  const std::size_t at = part.find_first_of("=!~");
  const bool is_not = at != std::string::npos && part[at] == '!';
  if (at == std::string::npos || (is_not && part.compare(at, 2, "!=") != 0)) {
    throw InputError(
        "where: '" + part +
        "': expected FIELD=TEXT, FIELD!=TEXT or FIELD~REGEX, for example metric=ate or "
        "method=\"a, b\"");
  }
  Condition out{
      part.substr(0, at), unquoted(part.substr(at + (is_not ? 2 : 1))), !is_not, std::nullopt};
  try {
    field(Record{}, out.field);
    if (part[at] == '~') out.pattern.emplace(out.text);
  } catch (const InputError& error) {
    throw InputError("where: '" + part + "': " + error.what());
  }
  return out;
}

bool holds(const Condition& condition, const Record& record) {
  const std::string text = field(record, condition.field);
  if (!record.has_score() && text.empty()) return true;
  const auto is = [&](const std::string& own) {
    return condition.pattern ? condition.pattern->matches_part(own) : own == condition.text;
  };
  const bool is_label = condition.field == "metric" && is(record.kind->metric_label());
  return (is(text) || is_label) == condition.is_wanted;
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> out;
  for (const std::string& part : split(text)) out.push_back(unquoted(part));
  return out;
}

std::vector<std::string> split_rules(const std::string& rule) { return split(rule); }

std::string field_of_rule(const std::string& rule) {
  return rule.substr(0, rule.find_first_of("=!~"));
}

std::function<bool(const Record&)> where(const std::vector<std::string>& rules) {
  std::vector<Condition> conditions;
  for (const std::string& rule : rules) {
    for (const std::string& part : split(rule)) conditions.push_back(condition(part));
  }
  return [conditions = std::move(conditions)](const Record& record) {
    return std::ranges::all_of(conditions, [&](const Condition& c) { return holds(c, record); });
  };
}

void keep_where(std::vector<Record>& records, const std::vector<std::string>& rules) {
  const auto kept = where(rules);
  std::erase_if(records, [&](const Record& record) { return !kept(record); });
}

}  // namespace loopbench::harness
