#include "harness/sweep/config/paths.hpp"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>

namespace loopbench::harness {
namespace {

/// Text options of datasets that name a file or folder.
const std::vector<std::string> kPathOptions{
    "path", "estimate", "reference", "frames", "times", "truth", "closures.file", "anchors.file"};

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

/// Splits a pattern into its wildcards and the texts between them, in order.
std::vector<std::string> parts_of(const std::string& pattern) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < pattern.size();) {
    const bool is_wildcard = has_wildcard(pattern.substr(at, 1));
    const std::size_t end = is_wildcard
                                ? wildcard_end(pattern, at)
                                : std::min(pattern.find_first_of("*?[", at), pattern.size());
    out.push_back(pattern.substr(at, end - at));
    at = end;
  }
  return out;
}

/// The pattern as a regular expression with a group for each wildcard.
std::regex expression_of(const std::string& pattern) {
  std::string out;
  for (std::string part : parts_of(pattern)) {
    if (part == "*") {
      out += "([^/]*?)";
    } else if (part == "?") {
      out += "([^/])";
    } else if (has_wildcard(part)) {
      if (part.starts_with("[!")) part[1] = '^';
      out += "(" + part + ")";
    } else {
      out += std::regex_replace(part, std::regex(R"([.^$|()\[\]{}*+?\\])"), R"(\$&)");
    }
  }
  return std::regex(out);
}

std::string escaped_pattern(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("*?[\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Files that match; relative patterns give relative paths.
std::vector<std::string> matching_files(const std::string& pattern, const Folders& folders) {
  const bool is_absolute = pattern.starts_with('/');
  for (const std::filesystem::path& folder : is_absolute ? Folders{""} : folders) {
    const std::string start = is_absolute ? "" : folder.string() + "/";
    glob_t found{};
    std::vector<std::string> out;
    if (glob((escaped_pattern(start) + pattern).c_str(), 0, nullptr, &found) == 0) {
      for (std::size_t i = 0; i < found.gl_pathc; ++i) {
        out.push_back(std::string(found.gl_pathv[i]).substr(start.size()));
      }
    }
    globfree(&found);
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
  try {
    std::smatch found;
    if (!std::regex_match(path, found, expression_of(pattern))) return {};
    return {found.begin() + 1, found.end()};
  } catch (const std::regex_error&) {  // brackets that do not close, for example
    return {};
  }
}

std::string with_wildcard_texts(const std::string& pattern, const std::vector<std::string>& texts) {
  std::string out;
  std::size_t used = 0;
  for (const std::string& part : parts_of(pattern)) {
    if (!has_wildcard(part)) {
      out += part;
    } else if (used++ < texts.size()) {
      out += texts[used - 1];
    }
  }
  return used == texts.size() ? out : "";
}

std::vector<GridPoint> expand_paths(const GridPoint& point,
                                    const std::vector<OptionInfo>& options,
                                    const Folders& folders) {
  GridPoint start = point;
  std::vector<Setting*> paths = paths_of(start, options);
  for (Setting* path : paths) {
    try {
      set_path(*path, expanded_path(path->text));
    } catch (const InputError& error) {
      throw path->place.error(path->name + ": " + error.what());
    }
  }
  const auto is_pattern = [&](const Setting* path) {
    return has_wildcard(path->text) && !is_file(path->text, folders);
  };
  const auto searched = std::ranges::find_if(paths, is_pattern);
  if (searched == paths.end()) return {start};
  const Setting pattern = **searched;
  const std::vector<std::string> files = matching_files(pattern.text, folders);
  if (files.empty()) throw pattern.place.error(pattern.name + ": no file matches " + pattern.text);
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
          throw path->place.error(path->name + ": expected as many wildcards as in " +
                                  pattern.name);
        }
        set_path(*path, paired);
      }
    }
  }
  return out;
}

}  // namespace loopbench::harness
