/// Reflection for options structs: one list of fields per struct provides defaults, parsing,
/// checks, the listing and the echo in results.
///
/// An options struct is any type with a free function that visits its members:
///
///     struct Options { double share = 1.0; Blend blend = Blend::slerp; };
///     template <class Visit> void fields(Options& o, Visit visit) {
///       visit("share", o.share, "fraction of the gap to close [-]", Between{0.0, 1.0});
///       visit("blend", o.blend, "interpolation of the rotation");
///     }
///
/// Members may be bool, int, std::int64_t, double, std::string, std::optional<double>
/// (written `none` when empty) and enums with `choices(Enum)`, an array of name-value pairs.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <sstream>
#include <type_traits>
#include <utility>

#include "datasets/core/params.hpp"

namespace loopbench {

/// Range check: low <= value <= high. NaN fails every check.
struct Between {
  double low;
  double high = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return low <= value && value <= high; }
  OptionRange range() const { return {low, high}; }
  std::string text(const std::string& name) const {
    const std::string upper = std::isinf(high) ? "" : " <= " + number(high);
    return number(low) + " <= " + name + upper;
  }

 private:
  static std::string number(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  }
};

/// Range check: low < value < infinity.
struct GreaterThan {
  double low;

  bool holds(double value) const { return value > low && std::isfinite(value); }
  OptionRange range() const { return {.low = low, .is_open = true}; }
  std::string text(const std::string& name) const {
    std::ostringstream out;
    out << name << " > " << low;
    return out.str();
  }
};

template <class T>
concept NamedEnum = std::is_enum_v<T> && requires(T value) {
  choices(value);
};

/// The name of an enum value. Throws std::logic_error if it has none.
template <NamedEnum E>
std::string to_text(E value) {
  for (const auto& [name, choice] : choices(value)) {
    if (choice == value) return name;
  }
  throw std::logic_error("enum value without a name");
}

/// All names of an enum.
template <NamedEnum E>
std::vector<std::string> choice_names(E any = {}) {
  std::vector<std::string> out;
  for (const auto& [name, choice] : choices(any)) out.emplace_back(name);
  return out;
}

/// The same as a text, for example "none | slerp".
template <NamedEnum E>
std::string choice_list(E any = {}) {
  std::string out;
  for (const std::string& name : choice_names(any)) out += (out.empty() ? "" : " | ") + name;
  return out;
}

/// The enum value with this name, or nothing.
template <NamedEnum E>
std::optional<E> from_text(const std::string& text) {
  for (const auto& [name, choice] : choices(E{})) {
    if (name == text) return choice;
  }
  return std::nullopt;
}

/// Conversion of one member type to and from Param. assign() throws OptionError with the expected
/// type.
template <class T>
struct FieldType {
  static Param to_param(const T& value) {
    if constexpr (NamedEnum<T>) {
      return to_text(value);
    } else if constexpr (std::integral<T> && !std::same_as<T, bool>) {
      return static_cast<std::int64_t>(value);
    } else {
      return value;
    }
  }

  static void assign(const std::string& name, T& member, const Param& given) {
    const auto mismatch = [&](const std::string& expected, UnknownWord unknown = {}) {
      return OptionError(
          name, name + " = " + to_text(given) + ": expected " + expected, std::move(unknown));
    };
    if constexpr (NamedEnum<T>) {
      const std::string* word = std::get_if<std::string>(&given);
      const auto value = word ? from_text<T>(*word) : std::nullopt;
      if (!value) {
        throw mismatch("one of " + choice_list<T>(), {to_text(given), choice_names<T>()});
      }
      member = *value;
    } else if constexpr (std::same_as<T, bool>) {
      const bool* flag = std::get_if<bool>(&given);
      if (flag == nullptr) throw mismatch("true or false");
      member = *flag;
    } else if constexpr (std::integral<T>) {
      const auto* integer = std::get_if<std::int64_t>(&given);
      if (integer == nullptr || !std::in_range<T>(*integer)) throw mismatch("a whole number");
      member = static_cast<T>(*integer);
    } else if constexpr (std::same_as<T, double>) {
      const auto* integer = std::get_if<std::int64_t>(&given);  // `gain: 1` is accepted as 1.0
      const double* real = std::get_if<double>(&given);
      if (integer == nullptr && real == nullptr) throw mismatch("a number");
      member = real != nullptr ? *real : static_cast<double>(*integer);
      if (std::isnan(member)) throw mismatch("a number");
    } else {
      static_assert(std::same_as<T, std::string>, "unsupported option type");
      // YAML parses `name: 07` as a number although the option is a text.
      member = to_text(given);
    }
  }
};

template <>
struct FieldType<std::optional<double>> {
  static Param to_param(const std::optional<double>& value) {
    return value ? Param(*value) : Param(std::string("none"));
  }
  static void assign(const std::string& name, std::optional<double>& member, const Param& given) {
    if (given == Param(std::string("none"))) {
      member.reset();
      return;
    }
    double value = 0.0;
    FieldType<double>::assign(name, value, given);
    member = value;
  }
};

namespace detail {

template <class T, class Rule>
void check_rule(const std::string& name, const T& member, const Rule& rule) {
  if constexpr (std::same_as<T, std::optional<double>>) {
    if (member) check_rule(name, *member, rule);
  } else if (!rule.holds(static_cast<double>(member))) {
    throw OptionError(
        name,
        name + " = " + to_text(FieldType<T>::to_param(member)) + ": expected " + rule.text(name));
  }
}

}  // namespace detail

/// Returns every option with its default, help and rule, in declaration order.
template <class Options>
std::vector<OptionInfo> describe(Options options) {
  std::vector<OptionInfo> out;
  fields(options, [&](const char* name, auto& member, const char* help, const auto&... rule) {
    using Member = std::remove_cvref_t<decltype(member)>;
    std::string text;
    if constexpr (NamedEnum<Member>) text = choice_list<Member>();
    ((text += (text.empty() ? "" : ", ") + rule.text(name)), ...);
    const bool is_text = std::same_as<Member, std::string> || NamedEnum<Member>;
    const bool is_optional = std::same_as<Member, std::optional<double>>;
    out.push_back({name, FieldType<Member>::to_param(member), help, text, is_text, is_optional});
    if constexpr (NamedEnum<Member>) out.back().words = choice_names<Member>();
    ((out.back().range = rule.range()), ...);
  });
  return out;
}

/// Returns the options as name-value pairs.
template <class Options>
Params echo(Options options) {
  Params out;
  for (OptionInfo& option : describe(options)) out.emplace(option.name, std::move(option.value));
  return out;
}

/// Returns `options` with the `given` fields replaced. Throws OptionError for an unknown name, a
/// wrong type or a value outside its range.
template <class Options>
Options with(Options options, Params given) {
  std::vector<std::string> known;
  fields(options, [&](const char* name, auto& member, const char*, const auto&... rule) {
    using Member = std::remove_cvref_t<decltype(member)>;
    known.emplace_back(name);
    if (const auto found = given.find(name); found != given.end()) {
      FieldType<Member>::assign(name, member, found->second);
      given.erase(found);
    }
    (detail::check_rule(name, member, rule), ...);
  });
  if (given.empty()) return options;
  const std::string& name = given.begin()->first;
  std::string all;
  for (const std::string& each : known) all += (all.empty() ? "" : ", ") + each;
  const std::string listing = " (has: " + (all.empty() ? "none" : all) + ")";
  throw OptionError(name, name + ": unknown option", {name, std::move(known), listing});
}

/// Options of methods, datasets and metrics that have none.
struct NoOptions {};

template <class Visit>
void fields(NoOptions&, Visit) {}

}  // namespace loopbench
