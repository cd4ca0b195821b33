/// Named settings as they travel between a config, an options struct and a result row.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace loopbench {

using Param = std::variant<bool, std::int64_t, double, std::string>;
using Params = std::map<std::string, Param>;

/// What `list` tells about one option.
struct OptionInfo {
  std::string name;
  Param value;           ///< the default
  std::string help;      ///< what it does, unit in brackets
  std::string rule;      ///< "0 <= share <= 1", "none | slerp", or empty
  bool is_text = false;  ///< holds text or a word of a list, whatever its default
};

/// An option was refused: unknown, of the wrong type, or against its rule.
class OptionError : public std::invalid_argument {
 public:
  OptionError(std::string option, const std::string& why)
      : std::invalid_argument(why), option_(std::move(option)) {}

  /// The name as given, for finding its place in a config.
  const std::string& option() const { return option_; }

 private:
  std::string option_;
};

/// Shortest text that reads back as the same double; "1" stays "1.0" so that types survive.
inline std::string to_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string out(buffer.data(), end);
  const bool bare = out.find_first_not_of("-0123456789") == std::string::npos;
  return bare ? out + ".0" : out;
}

inline std::string to_text(const Param& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const double* real = std::get_if<double>(&value)) return to_text(*real);
  return std::get<std::string>(value);
}

/// "a=1, b=slerp": one line for tables and row keys, sorted by name.
inline std::string to_text(const Params& params) {
  std::string out;
  for (const auto& [name, value] : params) {
    out += (out.empty() ? "" : ", ") + name + "=" + to_text(value);
  }
  return out;
}

}  // namespace loopbench
