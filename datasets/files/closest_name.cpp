#include "datasets/files/closest_name.hpp"

#include <algorithm>

namespace loopbench {
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

std::string similar_file(const std::filesystem::path& missing) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = missing.has_parent_path() ? missing.parent_path() : ".";
  for (fs::directory_iterator entry(folder, error), none; entry != none; entry.increment(error)) {
    if (entry->is_regular_file(error)) names.push_back(entry->path().filename());
  }
  const std::string best = closest(missing.filename(), names);
  return best.empty() ? "" : "; did you mean '" + best + "'?";
}

}  // namespace loopbench
