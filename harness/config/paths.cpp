#include "harness/config/paths.hpp"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// Text options of datasets that name a file or folder.
const std::vector<std::string> kPathOptions{
    "path", "estimate", "reference", "frames", "truth", "closures.file"};

constexpr std::size_t kMostFiles = 10'000;

bool has_wildcard(const std::string& text) {
  return text.find_first_of("*?[") != std::string::npos;
}

/// A file can have wildcards in its name.
bool is_file(const std::string& text, const Folders& folders) {
  return std::ranges::any_of(
      folders, [&](const auto& folder) { return std::filesystem::exists(folder / text); });
}

/// Index after the wildcard that starts at `at`.
std::size_t wildcard_end(const std::string& pattern, std::size_t at) {
  if (pattern[at] != '[') return at + 1;
  const std::size_t close = pattern.find(']', at + 2);
  return close == std::string::npos ? at + 1 : close + 1;
}

bool in_brackets(const std::string& brackets, char c) {
  const bool is_negated = brackets[1] == '!' || brackets[1] == '^';
  bool found = false;
  for (std::size_t i = is_negated ? 2 : 1; i + 1 < brackets.size(); ++i) {
    const bool is_range = i + 3 < brackets.size() && brackets[i + 1] == '-';
    found = found || (is_range ? brackets[i] <= c && c <= brackets[i + 2] : brackets[i] == c);
    if (is_range) i += 2;
  }
  return found != is_negated && c != '/';
}

bool match_from(const std::string& pattern,
                std::size_t p,
                const std::string& path,
                std::size_t t,
                std::vector<std::string>& texts) {
  if (p == pattern.size()) return t == path.size();
  if (std::string_view("*?[").find(pattern[p]) == std::string_view::npos) {
    return t < path.size() && path[t] == pattern[p] &&
           match_from(pattern, p + 1, path, t + 1, texts);
  }
  const std::size_t next = wildcard_end(pattern, p);
  const bool is_star = pattern[p] == '*';
  for (std::size_t length = is_star ? 0 : 1; t + length <= path.size(); ++length) {
    if (length > 0) {
      const char c = path[t + length - 1];
      if (c == '/') return false;
      if (pattern[p] == '[' && !in_brackets(pattern.substr(p, next - p), c)) return false;
    }
    texts.push_back(path.substr(t, length));
    if (match_from(pattern, next, path, t + length, texts)) return true;
    texts.pop_back();
    if (!is_star) return false;
  }
  return false;
}

std::string escaped_pattern(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("*?[\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Pipes and devices would be waited for, or read without end, when the sweep starts.
void reject_special_file(const std::string& pattern,
                         const std::string& file,
                         const std::filesystem::path& found) {
  std::error_code absent;  // a link to nothing is reported when it is read
  if (!std::filesystem::is_other(std::filesystem::status(found, absent))) return;
  throw InputError(pattern + " matches " + file + ", which is neither a regular file nor a folder");
}

/// Files that match; relative patterns give relative paths. Throws InputError for pipes, sockets
/// and devices.
std::vector<std::string> matching_files(const std::string& pattern, const Folders& folders) {
  const bool is_absolute = pattern.starts_with('/');
  for (const std::filesystem::path& folder : is_absolute ? Folders{""} : folders) {
    const std::string start = is_absolute ? "" : folder.string() + "/";
    glob_t found{};
    std::vector<std::string> out;
    if (glob((escaped_pattern(start) + pattern).c_str(), 0, nullptr, &found) == 0) {
      for (std::size_t i = 0; i < found.gl_pathc; ++i) {
        out.emplace_back(found.gl_pathv[i]);
      }
    }
    globfree(&found);
    for (std::string& path : out) {
      const std::string file = path.substr(start.size());
      reject_special_file(pattern, file, path);
      path = file;
    }
    if (!out.empty()) return out;
  }
  return {};
}

std::vector<Setting*> paths_of(GridPoint& point, const std::vector<OptionInfo>& options) {
  std::vector<Setting*> out;
  for (Setting& setting : point.settings) {
    const auto option = std::ranges::find(options, setting.name, &OptionInfo::name);
    const bool is_path = option != options.end() && option->is_text &&
                         std::ranges::count(kPathOptions, setting.name) > 0;
    if (is_path && !setting.text.empty()) out.push_back(&setting);
  }
  return out;
}

void set_path(Setting& setting, const std::string& text) {
  setting.text = text;
  setting.value = text;
}

}  // namespace

std::string expanded_path(const std::string& text) {
  const auto variable = [](const std::string& name) {
    const char* value = std::getenv(name.c_str());
    if (value == nullptr) throw InputError("the environment variable " + name + " is not set");
    return std::string(value);
  };
  std::string out;
  std::size_t at = 0;
  if (text == "~" || text.starts_with("~/")) {
    out = variable("HOME");
    at = 1;
  }
  const auto is_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  while (at < text.size()) {
    if (text[at] != '$') {
      out += text[at++];
      continue;
    }
    const bool has_braces = at + 1 < text.size() && text[at + 1] == '{';
    const std::size_t begin = at + (has_braces ? 2 : 1);
    std::size_t end = begin;
    while (end < text.size() && is_name(text[end])) ++end;
    const bool is_complete =
        end > begin && (!has_braces || (end < text.size() && text[end] == '}'));
    if (!is_complete) {
      out += text[at++];
      continue;
    }
    out += variable(text.substr(begin, end - begin));
    at = end + (has_braces ? 1 : 0);
  }
  return out;
}

std::vector<std::string> wildcard_texts(const std::string& pattern, const std::string& path) {
  std::vector<std::string> out;
  if (!match_from(pattern, 0, path, 0, out)) out.clear();
  return out;
}

std::string with_wildcard_texts(const std::string& pattern, const std::vector<std::string>& texts) {
  std::string out;
  std::size_t used = 0;
  for (std::size_t at = 0; at < pattern.size();) {
    if (!has_wildcard(pattern.substr(at, 1))) {
      out += pattern[at++];
      continue;
    }
    at = wildcard_end(pattern, at);
    if (used == texts.size()) return "";
    out += texts[used++];
  }
  return used == texts.size() ? out : "";
}

std::vector<GridPoint> expand_paths(const GridPoint& point,
                                    const std::vector<OptionInfo>& options,
                                    const Folders& folders,
                                    const std::string& file) {
  GridPoint start = point;
  std::vector<Setting*> paths = paths_of(start, options);
  for (Setting* path : paths) {
    try {
      set_path(*path, expanded_path(path->text));
    } catch (const InputError& error) {
      throw input_error(file, path->line, path->name + ": " + error.what());
    }
  }
  const auto is_pattern = [&](const Setting* path) {
    return has_wildcard(path->text) && !is_file(path->text, folders);
  };
  const auto searched = std::ranges::find_if(paths, is_pattern);
  if (searched == paths.end()) return {start};
  const Setting pattern = **searched;
  const std::vector<std::string> files = [&] {
    try {
      return matching_files(pattern.text, folders);
    } catch (const InputError& error) {
      throw input_error(file, pattern.line, pattern.name + ": " + error.what());
    }
  }();
  if (files.empty()) {
    throw input_error(file, pattern.line, pattern.name + ": no file matches " + pattern.text);
  }
  if (files.size() > kMostFiles) {
    throw input_error(file, pattern.line, pattern.name + ": more than 10000 files match");
  }
  std::vector<GridPoint> out;
  for (const std::string& match : files) {
    GridPoint& next = out.emplace_back(start);
    next.matched = wildcard_texts(pattern.text, match);
    for (Setting* path : paths_of(next, options)) {
      if (path->name == pattern.name) {
        set_path(*path, match);
      } else if (has_wildcard(path->text)) {
        const std::string paired = with_wildcard_texts(path->text, next.matched);
        if (paired.empty()) {
          throw input_error(
              file, path->line, path->name + ": expected as many wildcards as in " + pattern.name);
        }
        set_path(*path, paired);
      }
    }
  }
  return out;
}

}  // namespace loopbench::harness
