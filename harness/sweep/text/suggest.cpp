#include "harness/sweep/text/suggest.hpp"

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
  const UnknownWord& unknown = error.unknown();
  std::string out = error.what();
  std::vector<std::string> known = unknown.known;
  const bool is_option = !unknown.listing.empty();
  if (is_option) known.insert(known.begin(), further.begin(), further.end());
  const std::string best = closest(unknown.word, known);
  if (best.empty()) return out;
  return out.insert(out.size() - unknown.listing.size(), "; did you mean '" + best + "'?");
}

}  // namespace loopbench::harness
