#include <algorithm>
#include <string>

#include "harness/pages/command_pages.hpp"

namespace loopbench::harness {
namespace {

/// Escapes text for roff; `-` is a minus sign, so that options can be copied.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_line_start = i == 0 || text[i - 1] == '\n';
    if (is_line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

/// loopbench-traj-crop
std::string manual_name(const CommandText& one) {
  std::string out = one.name.empty() ? "loopbench" : "loopbench-" + one.name;
  std::ranges::replace(out, ' ', '-');
  return out;
}

std::string synopsis(const CommandText& one) {
  if (one.name.empty()) return ".B loopbench\n.I COMMAND\n[\\fIOPTIONS\\fR]\n";
  std::string out = ".B loopbench " + roff(one.name) + "\n";
  for (const CommandOption& option : one.options) {
    if (!option.is_argument) continue;
    const std::string name = "\\fI" + roff(option.names[0]) + "\\fR";
    out += option.is_required ? name + "\n" : "[" + name + "]\n";
  }
  return out + "[\\fIOPTIONS\\fR]\n";
}

std::string option_text(const CommandOption& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
  }
  std::string value = option.is_argument ? "" : option.value;
  if (!option.choices.empty()) {
    value.clear();
    for (const std::string& word : option.choices) value += (value.empty() ? "" : "|") + word;
  }
  if (!value.empty()) value = " \\fI" + roff(value) + "\\fR";
  std::string out = ".TP\n" + names + value + "\n" + roff(option.help);
  if (!option.usual.empty()) out += " (default: " + roff(option.usual) + ")";
  return out + "\n";
}

}  // namespace

std::string manual_page(const CommandTexts& all,
                        const CommandText& one,
                        const std::string& version) {
  const std::string title = manual_name(one);
  std::string out =
      ".TH " + roff(title) + " 1 \"\" \"loopbench " + version + "\" \"User Commands\"\n";
  out += ".SH NAME\n" + roff(title) + " \\- " + roff(one.summary) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(one);
  if (one.name.empty()) {
    out += ".SH COMMANDS\n";
    for (const CommandText& each : all) {
      if (each.name.empty()) continue;
      out += ".TP\n\\fB" + roff(manual_name(each)) + "\\fR(1)\n" + roff(each.summary) + "\n";
    }
  }
  out += ".SH OPTIONS\n";
  for (const CommandOption& option : one.options) out += option_text(option);
  if (!one.footer.empty()) out += ".SH NOTES\n.nf\n" + roff(one.footer) + "\n.fi\n";
  out += ".SH SEE ALSO\n";
  out += one.name.empty() ? "The documents in /usr/share/doc/loopbench.\n" : ".BR loopbench (1)\n";
  return out;
}

std::map<std::string, std::string> command_pages(const CommandTexts& all,
                                                 const std::string& version) {
  std::map<std::string, std::string> out{{"loopbench.bash", bash_completion(all)},
                                         {"_loopbench", zsh_completion(all)},
                                         {"loopbench.fish", fish_completion(all)}};
  for (const CommandText& one : all) {
    out[manual_name(one) + ".1"] = manual_page(all, one, version);
  }
  return out;
}

}  // namespace loopbench::harness
