#include "metrics/protocols/lengths.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

#include "datasets/core/params.hpp"

namespace loopbench::metrics {
namespace {

Length read(const std::string& option, const std::string& word) {
  Length out;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, out.value);
  const std::string unit(rest, end);
  const bool is_known = unit.empty() || unit == "%" || unit == "m";
  if (error != std::errc{} || !is_known || !std::isfinite(out.value) || out.value < 0.0) {
    throw OptionError(option,
                      option + ": '" + word + "': expected a length in metres or %, as 100 or 20%");
  }
  out.is_share = unit == "%";
  const std::string number(word.data(), rest);
  out.text = out.is_share ? number + "%" : number + " m";
  if (out.is_share) out.value /= 100.0;
  return out;
}

}  // namespace

std::vector<Length> lengths(const std::string& option, const std::string& text) {
  std::vector<Length> out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    out.push_back(read(option, word));
    if (out.back().value > 0.0) continue;
    throw OptionError(option, option + ": '" + word + "': expected a positive number");
  }
  if (out.empty()) throw OptionError(option, option + ": is empty, expected lengths as 100 20%");
  return out;
}

Length tolerance(const std::string& option, const std::string& text) { return read(option, text); }

}  // namespace loopbench::metrics
