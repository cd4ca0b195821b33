#include "harness/pages/command_pages.hpp"

namespace loopbench::harness {
namespace {

std::string words_joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

std::vector<std::string> command_names(const CommandTexts& all) {
  std::vector<std::string> out;
  for (const CommandText& one : all) {
    if (!one.name.empty()) out.push_back(one.name);
  }
  return out;
}

std::vector<std::string> option_names(const CommandText& one) {
  std::vector<std::string> out;
  for (const CommandOption& option : one.options) {
    if (!option.is_argument) out.insert(out.end(), option.names.begin(), option.names.end());
  }
  return out;
}

/// The text between single quotes of bash, zsh or fish, with each of `special` escaped.
std::string escaped_help(const std::string& text, const std::string& special) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (special.find(c) != std::string::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string bash_completion(const CommandTexts& all) {
  std::string out =
      "# bash completion for loopbench\n"
      "_loopbench() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '" +
      words_joined(command_names(all)) + " " + words_joined(option_names(all.front())) +
      "' -- \"$word\")\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n";
  for (const CommandText& one : all) {
    if (one.name.empty()) continue;
    out += "    " + one.name + ")\n      case $before in\n";
    for (const CommandOption& option : one.options) {
      if (option.choices.empty() || option.is_argument) continue;
      std::string names;
      for (const std::string& name : option.names) names += (names.empty() ? "" : " | ") + name;
      out += "        " + names + ") words='" + words_joined(option.choices) + "' ;;\n";
    }
    out += "        *) if [[ $word == -* ]]; then words='" + words_joined(option_names(one)) +
           "'; fi ;;\n      esac\n";
    if (one.name == "help") {
      out += "      words='" + words_joined(command_names(all)) + "'\n";
    }
    out += "      ;;\n";
  }
  return out +
         "  esac\n"
         "  [[ -n $words ]] && mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
         "}\n"
         "complete -o default -F _loopbench loopbench\n";
}

std::string zsh_completion(const CommandTexts& all) {
  std::string out = "#compdef loopbench\n_loopbench() {\n  local -a commands=(\n";
  for (const CommandText& one : all) {
    if (one.name.empty()) continue;
    out += "    '" + one.name + ":" + escaped_help(one.summary, ":") + "'\n";
  }
  out +=
      "  )\n"
      "  if ((CURRENT == 2)); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  ((CURRENT--))\n  case $command in\n";
  for (const CommandText& one : all) {
    if (one.name.empty()) continue;
    out += "    " + one.name + ")\n      _arguments";
    for (const CommandOption& option : one.options) {
      if (option.is_argument) continue;
      for (const std::string& name : option.names) {
        const std::string help = "[" + escaped_help(option.help, "[]:") + "]";
        std::string value;
        if (!option.choices.empty()) {
          value = ":value:(" + words_joined(option.choices) + ")";
        } else if (!option.value.empty()) {
          value = ":" + escaped_help(option.value, ":") + ":_files";
        }
        out += " \\\n        '" + name + help + value + "'";
      }
    }
    out += one.name == "help"
               ? " \\\n        '*:command:(" + words_joined(command_names(all)) + ")'\n"
               : " \\\n        '*:file:_files'\n";
    out += "      ;;\n";
  }
  return out + "  esac\n}\n_loopbench \"$@\"\n";
}

std::string fish_completion(const CommandTexts& all) {
  std::string out = "# fish completion for loopbench\n";
  for (const CommandText& one : all) {
    if (!one.name.empty()) {
      out += "complete -c loopbench -n __fish_use_subcommand -f -a " + one.name + " -d '" +
             escaped_help(one.summary, "\\") + "'\n";
    }
    for (const CommandOption& option : one.options) {
      if (option.is_argument) continue;
      out += "complete -c loopbench -n " + (one.name.empty()
                                                ? "__fish_use_subcommand"
                                                : "'__fish_seen_subcommand_from " + one.name + "'");
      for (const std::string& name : option.names) {
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.choices.empty()) {
        out += " -x -a '" + words_joined(option.choices) + "'";
      } else if (!option.value.empty()) {
        out += " -r";
      }
      out += " -d '" + escaped_help(option.help, "\\") + "'\n";
    }
  }
  return out;
}

}  // namespace loopbench::harness
