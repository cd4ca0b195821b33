#include "harness/sweep/process/mounts.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

/// Blanks and backslashes are octal numbers there.
std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_octal = text[i] == '\\' && i + 3 < text.size();
    out += is_octal ? static_cast<char>(std::stoi(text.substr(i + 1, 3), nullptr, 8)) : text[i];
    if (is_octal) i += 3;
  }
  return out;
}

fs::path joined(const fs::path& folder, const fs::path& rest) {
  return rest.empty() ? folder : folder / rest;
}

/// The path below the folder; nothing unless it is there.
std::optional<fs::path> below(const fs::path& folder, const fs::path& path) {
  const auto [rest, from] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  if (rest != folder.end() && !rest->empty()) return std::nullopt;
  fs::path out;
  for (auto part = from; part != path.end(); ++part) out /= *part;
  return out;
}

}  // namespace

std::vector<Mount> mounts_in(const std::string& mountinfo) {
  std::vector<Mount> out;
  std::istringstream lines(mountinfo);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string id, parent, root, point;
    Mount one;
    if (!(words >> id >> parent >> one.device >> root >> point)) continue;
    one.root = unescaped(root);
    one.point = unescaped(point);
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<fs::path> other_names(const fs::path& path, const std::vector<Mount>& mounts) {
  const Mount* own = nullptr;  // the last one of those that are nearest
  for (const Mount& each : mounts) {
    if (!below(each.point, path)) continue;
    if (own == nullptr || below(own->point, each.point)) own = &each;
  }
  std::vector<fs::path> out;
  if (own == nullptr) return out;
  const fs::path place = joined(own->root, *below(own->point, path));
  for (const Mount& each : mounts) {
    const auto rest = below(each.root, place);
    if (&each == own || each.device != own->device || !rest) continue;
    const fs::path name = joined(each.point, *rest);
    if (name != path && std::ranges::count(out, name) == 0) out.push_back(name);
  }
  return out;
}

}  // namespace loopbench::harness
