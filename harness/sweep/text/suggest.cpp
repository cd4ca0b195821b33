#include "harness/sweep/text/suggest.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace loopbench::harness {
std::string unknown_name(const std::string& kind,
                         const std::string& given,
                         const std::vector<std::string>& known) {
  const std::string what = "no " + kind + " is named '" + given + "'";
  if (const std::string best = closest(given, known); !best.empty()) {
    return what + "; did you mean '" + best + "'?";
  }
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? what : what + " (known: " + all + ")";
}

std::string with_guess(const OptionError& error, const std::vector<std::string>& further) {
  std::string why = error.what();
  constexpr std::string_view kOptions = " (has: ", kValues = ": expected one of ";
  const std::size_t options = why.rfind(kOptions), values = why.rfind(kValues);
  const std::size_t begin = error.option().size() + 3;  // of VALUE after "NAME = "
  const bool has_options = options != std::string::npos;
  if (!has_options && (values == std::string::npos || values < begin)) return why;
  std::vector<std::string> known = has_options ? further : std::vector<std::string>{};
  std::istringstream list(
      why.substr(has_options ? options + kOptions.size() : values + kValues.size()));
  for (std::string word; list >> word;) {
    if (word != "|") known.push_back(word.substr(0, word.find_first_of(",)")));
  }
  const std::string best =
      closest(has_options ? error.option() : why.substr(begin, values - begin), known);
  if (best.empty()) return why;
  return why.insert(std::min(options, why.size()), "; did you mean '" + best + "'?");
}

}  // namespace loopbench::harness
