/// Option values by name, exchanged between configs, options structs and result rows.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace loopbench {

using Param = std::variant<bool, std::int64_t, double, std::string>;
using Params = std::map<std::string, Param>;

/// Bounds of a number; infinite without.
struct OptionRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_open = false;  ///< without `low` itself
};

/// Description of one option, as printed by `list`.
struct OptionInfo {
  std::string name;
  Param value;               ///< the default
  std::string help;          ///< meaning, with the unit in brackets
  std::string rule;          ///< "0 <= share <= 1", "none | slerp", or empty
  bool is_text = false;      ///< holds text or one of a list of words, whatever its default
  bool is_optional = false;  ///< a number that can also be `none`
  OptionRange range = {};    ///< of a number, as in `rule`
  std::vector<std::string> words = {};  ///< those of `rule`; none: any text
};

/// A word where one of a list was expected.
struct UnknownWord {
  std::string word;
  std::vector<std::string> known;
  std::string listing = {};  ///< end of the message, a list of options; empty for a value
};

/// Invalid option: unknown name, wrong type, or value outside its range.
class OptionError : public std::invalid_argument {
 public:
  /// The message ends with the listing of `unknown`.
  OptionError(std::string option, const std::string& message, UnknownWord unknown = {})
      : std::invalid_argument(message + unknown.listing),
        option_(std::move(option)),
        unknown_(std::move(unknown)) {}

  /// The option name as given, used to find its line in a config.
  const std::string& option() const { return option_; }

  /// Without a word if no word is the error.
  const UnknownWord& unknown() const { return unknown_; }

 private:
  std::string option_;
  UnknownWord unknown_;
};

/// Shortest text that parses to the same double; 1 is printed as "1.0" to preserve the type.
inline std::string to_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string out(buffer.data(), end);
  const bool is_integer_text = out.find_first_not_of("-0123456789") == std::string::npos;
  return is_integer_text ? out + ".0" : out;
}

inline std::string to_text(const Param& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* real = std::get_if<double>(&value)) return to_text(*real);
  return std::get<std::string>(value);
}

/// One line for tables and row keys, sorted by name: "a=1, b=slerp".
inline std::string to_text(const Params& params) {
  std::string out;
  for (const auto& [name, value] : params) {
    out += (out.empty() ? "" : ", ") + name + "=" + to_text(value);
  }
  return out;
}

}  // namespace loopbench
