#include "harness/commands/file_kinds.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

#include "datasets/core/error.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench::harness {
namespace {

/// The first and the last bytes of a file; empty if it cannot be read.
struct FileEnds {
  std::string first;
  std::string last;
};

FileEnds ends_of(const std::filesystem::path& file) {
  constexpr std::streamsize kMost = 64 << 10;  // [bytes], of each end
  std::ifstream in(file, std::ios::binary);
  const auto read = [&] {
    std::string out(static_cast<std::size_t>(kMost), '\0');
    in.read(out.data(), kMost);
    out.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
    return out;
  };
  FileEnds out{read(), {}};
  if (static_cast<std::streamsize>(out.first.size()) < kMost) return out;
  in.clear();
  in.seekg(-kMost, std::ios::end);
  out.last = read();
  return out;
}

template <std::size_t N>
bool begins_with_any(std::string_view text, const std::array<std::string_view, N>& beginnings) {
  return std::ranges::any_of(beginnings,
                             [&](std::string_view each) { return text.starts_with(each); });
}

/// Whether the text has this key of a config: at the beginning of a line of YAML, or as the first
/// word after a brace or a comma, or a quoted one, of JSON.
bool has_config_key(std::string_view text, std::string_view key) {
  constexpr std::string_view kBlanks = " \t\r\n\"";
  for (std::size_t at = text.find(key); at != std::string_view::npos;
       at = text.find(key, at + key.size())) {
    const std::size_t end = text.find_first_not_of(" \"", at + key.size());
    if (end == std::string_view::npos || text[end] != ':') continue;
    if (at == 0 || text[at - 1] == '\n') return true;
    const std::size_t before = text.find_last_not_of(kBlanks, at - 1);
    if (before == std::string_view::npos || text[before] == '{' || text[before] == ',') return true;
  }
  return false;
}

/// A page of results contains the config of its sweep.
bool is_config(std::string_view text) {
  return !text.starts_with("<!DOCTYPE") && has_config_key(text, "datasets") &&
         has_config_key(text, "methods");
}

bool is_baseline(std::string_view text) {
  return text.starts_with('{') && text.substr(0, 100).find("\"loopbench_baseline\":") != text.npos;
}

/// First lines of tables in CSV.
constexpr std::array<std::string_view, 6> kHeaders{"sequence,repeat,method,",
                                                   "table,row,column,value,",
                                                   "protocol,times,metric,label,",
                                                   "reference,estimate,protocol,",
                                                   "from,to,place,",
                                                   "file,reference,key,"};

/// Beginnings of other texts: `eval`, `check --junit`.
constexpr std::array<std::string_view, 2> kBeginnings{
    "reference  ", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"loopbench "};

/// Parts of texts and JSON of results that other files do not have.
constexpr std::array<std::string_view, 8> kParts{"<!-- source: ",
                                                 "\"loopbench\": \"",
                                                 "\"executable\": \"loopbench\"",
                                                 "| estimate ",
                                                 " regressions, ",
                                                 "/results.sqlite\n",
                                                 "rmse against ",
                                                 "no verdict: "};

/// "loopbench 1.0.0 (", as build_summary() begins.
bool has_build(std::string_view text) {
  constexpr std::string_view kName = "loopbench ";
  for (std::size_t at = text.find(kName); at != text.npos; at = text.find(kName, at + 1)) {
    const std::string_view version = text.substr(at + kName.size());
    const std::size_t end = version.find_first_not_of("0123456789.");
    if (end != version.npos && end >= 5 && version.substr(end).starts_with(" (")) return true;
  }
  return false;
}

bool has_results(const FileEnds& ends) {
  if (begins_with_any(ends.first, kHeaders) || begins_with_any(ends.first, kBeginnings))
    return true;
  for (const std::string* const text : {&ends.first, &ends.last}) {
    if (has_build(*text)) return true;
    for (const std::string_view part : kParts) {
      if (text->find(part) != std::string::npos) return true;
    }
  }
  const bool is_evaluation = ends.first.find("\"protocol\": {") != std::string::npos &&
                             ends.first.find("\"estimate\": \"") != std::string::npos;
  return ends.first.starts_with('[') && is_evaluation;
}

/// One number per line, with comments.
bool is_stamps(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const bool is_last = end == text.size();  // can be cut
    text.remove_prefix(is_last ? end : end + 1);
    if (line.empty() || line.front() == '#' || is_last) continue;
    if (line.find_first_not_of("0123456789.+-eE\r") != line.npos) return false;
  }
  return true;
}

bool is_trajectory(const std::filesystem::path& file) {
  try {
    return detect_format(file) != Format::bag && !read_trajectory(file).empty();
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::string noun_of(FileKind kind) {
  switch (kind) {
    case FileKind::trajectory:
      return "a trajectory";
    case FileKind::stamps:
      return "a file of stamps";
    case FileKind::printed:
      return "a table or text of results";
    case FileKind::page:
      return "a page of results";
    case FileKind::figure:
      return "a figure";
    case FileKind::drawing_script:
      return "a script or data of a figure";
    case FileKind::job_script:
      return "a script of submit";
    case FileKind::baseline:
      return "a baseline";
  }
  return "";
}

std::string protected_content(const std::filesystem::path& file) {
  for (const std::string_view tail : {"-journal", "-wal", "-shm"}) {
    const std::string name = file.string();
    if (!name.ends_with(".sqlite" + std::string(tail))) continue;
    return "what SQLite writes beside a store";
  }
  const std::string text = ends_of(file).first;
  constexpr std::string_view kJournal = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  const bool is_log = text.starts_with("\x37\x7f\x06") || text.starts_with(kJournal);
  if (text.starts_with("SQLite format 3") || is_log)
    return "a store of results, or another database";
  if (is_baseline(text)) return "a baseline";
  return is_config(text) ? "a config" : "";
}

bool has_kind(const std::filesystem::path& file, FileKind kind) {
  const FileEnds ends = ends_of(file);
  std::error_code error;
  if (ends.first.empty()) return std::filesystem::file_size(file, error) == 0 && !error;
  const auto has = [&](std::string_view part) {
    return ends.first.find(part) != std::string::npos || ends.last.find(part) != std::string::npos;
  };
  switch (kind) {
    case FileKind::trajectory:
      return is_trajectory(file);
    case FileKind::stamps:
      return is_stamps(ends.first);
    case FileKind::printed:
      return has_results(ends);
    case FileKind::page:
      return has(" - loopbench</title>");
    case FileKind::figure:
      return has("Matplotlib") || has("matplotlib");
    case FileKind::drawing_script:
      return has("from loopbench import draw") || has("\"curves\": [");
    case FileKind::job_script:
      return has("#SBATCH --open-mode=append");
    case FileKind::baseline:
      return is_baseline(ends.first);
  }
  return false;
}

}  // namespace loopbench::harness
