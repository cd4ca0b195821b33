#include "harness/sweep/text/suggest.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string_view>

namespace loopbench::harness {
namespace {

std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t swap = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + swap});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string closest(const std::string& given, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(given.size() < 5 ? 1 : 2, given.size() / 3) + 1;
  const auto alike = [&](const std::string& name) {
    return std::ranges::mismatch(given, name).in1 - given.begin();
  };
  for (const std::string& name : known) {
    // Each surplus character is an edit, so much longer names need no comparison.
    if (given.size() >= name.size() + best_distance) continue;
    const std::size_t d = distance(given, name);
    const bool begins_alike = d == best_distance && !best.empty() && alike(name) > alike(best);
    if (d < best_distance || begins_alike) {
      best = name;
      best_distance = d;
    }
  }
  return best;
}

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

std::string with_similar_file(std::string message) {
  namespace fs = std::filesystem;
  const std::size_t end = message.find(": no such file");
  if (end == std::string::npos) return message;
  const std::size_t place = message.rfind(": ", end - 1);  // of a config that names the file
  const std::size_t begin = place == std::string::npos ? 0 : place + 2;
  const fs::path file = message.substr(begin, end - begin);
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (fs::directory_iterator entry(folder, error), none; entry != none; entry.increment(error)) {
    if (entry->is_regular_file(error)) names.push_back(entry->path().filename());
  }
  const std::string best = closest(file.filename(), names);
  return best.empty() ? message : message + "; did you mean '" + best + "'?";
}

}  // namespace loopbench::harness
