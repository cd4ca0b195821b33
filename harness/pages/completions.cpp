#include "harness/pages/command_pages.hpp"

namespace loopbench::harness {
namespace {

std::string words_joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

/// The command that `one` is a subcommand of; empty for the program and its commands.
std::string parent_of(const CommandText& one) {
  const std::size_t space = one.name.find(' ');
  return space == std::string::npos ? "" : one.name.substr(0, space);
}

std::string last_word(const CommandText& one) { return one.name.substr(one.name.rfind(' ') + 1); }

/// The subcommands of a command, or with an empty `parent` the commands of the program.
CommandTexts children_of(const std::string& parent, const CommandTexts& all) {
  CommandTexts out;
  for (const CommandText& one : all) {
    if (!one.name.empty() && parent_of(one) == parent) out.push_back(one);
  }
  return out;
}

std::vector<std::string> last_words(const CommandTexts& some) {
  std::vector<std::string> out;
  for (const CommandText& one : some) out.push_back(last_word(one));
  return out;
}

std::vector<std::string> command_names(const CommandTexts& all) {
  return last_words(children_of("", all));
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

/// "_arguments" with the options of a command; `rest`: what completes its other arguments.
std::string zsh_arguments(const CommandText& one, const std::string& rest) {
  std::string out = "_arguments";
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
  return out + " \\\n        '" + rest + "'\n";
}

/// "_describe" with some commands and their summaries.
std::string zsh_commands(const CommandTexts& some) {
  std::string out = "  local -a commands=(\n";
  for (const CommandText& one : some) {
    out += "    '" + last_word(one) + ":" + escaped_help(one.summary, ":") + "'\n";
  }
  return out + "  )\n  _describe command commands\n";
}

/// Completes the word after the parent by the children of `parent`, further words by their options.
std::string zsh_case(const std::string& parent, const CommandTexts& all) {
  std::string out = "  if ((CURRENT == 2)); then\n" + zsh_commands(children_of(parent, all)) +
                    "    return\n  fi\n  shift words\n  ((CURRENT--))\n  case $words[1] in\n";
  for (const CommandText& one : children_of(parent, all)) {
    out += "    " + last_word(one) + ")\n      ";
    if (!children_of(one.name, all).empty()) {
      out += "_loopbench_" + one.name + "\n";
    } else if (one.name == "help") {
      out += zsh_arguments(one, "*:command:(" + words_joined(command_names(all)) + ")");
    } else {
      out += zsh_arguments(one, "*:file:_files");
    }
    out += "      ;;\n";
  }
  return out + "  esac\n";
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
      "' -- \"$word\")\n    return\n  fi\n  local command=${COMP_WORDS[1]}\n";
  for (const CommandText& one : children_of("", all)) {
    if (children_of(one.name, all).empty()) continue;
    out += "  [[ $command == " + one.name +
           " ]] && ((COMP_CWORD > 2)) && command+=\" ${COMP_WORDS[2]}\"\n";
  }
  out += "  case $command in\n";
  for (const CommandText& one : all) {
    if (one.name.empty()) continue;
    out += "    '" + one.name + "')\n      case $before in\n";
    for (const CommandOption& option : one.options) {
      if (option.choices.empty() || option.is_argument) continue;
      std::string names;
      for (const std::string& name : option.names) names += (names.empty() ? "" : " | ") + name;
      out += "        " + names + ") words='" + words_joined(option.choices) + "' ;;\n";
    }
    out += "        *) if [[ $word == -* ]]; then words='" + words_joined(option_names(one)) +
           "'; fi ;;\n      esac\n";
    const CommandTexts children =
        one.name == "help" ? children_of("", all) : children_of(one.name, all);
    if (!children.empty()) {
      out += "      [[ -n $words ]] || words='" + words_joined(last_words(children)) + "'\n";
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
  std::string out = "#compdef loopbench\n";
  for (const CommandText& one : children_of("", all)) {
    if (children_of(one.name, all).empty()) continue;
    out += "_loopbench_" + one.name + "() {\n" + zsh_case(one.name, all) + "}\n";
  }
  return out + "_loopbench() {\n" + zsh_case("", all) + "}\n_loopbench \"$@\"\n";
}

std::string fish_completion(const CommandTexts& all) {
  std::string out = "# fish completion for loopbench\n";
  const std::string seen = "__fish_seen_subcommand_from ";
  for (const CommandText& one : all) {
    const std::string parent = parent_of(one);
    if (!one.name.empty()) {
      const std::string siblings = words_joined(last_words(children_of(parent, all)));
      const std::string where = parent.empty()
                                    ? "__fish_use_subcommand"
                                    : "'" + seen + parent + "; and not " + seen + siblings + "'";
      out += "complete -c loopbench -n " + where + " -f -a " + last_word(one) + " -d '" +
             escaped_help(one.summary, "\\") + "'\n";
    }
    std::string where = "__fish_use_subcommand";
    if (!one.name.empty()) {
      where = "'" + (parent.empty() ? "" : seen + parent + "; and ") + seen + last_word(one);
      for (const CommandText& other : all) {  // `plot`, but not `traj plot`
        const bool has_same_name = other.name != one.name && last_word(other) == one.name;
        if (has_same_name) where += "; and not " + seen + parent_of(other);
      }
      where += "'";
    }
    for (const CommandOption& option : one.options) {
      if (option.is_argument) continue;
      out += "complete -c loopbench -n " + where;
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

std::map<std::string, std::string> command_pages(const CommandTexts& all) {
  std::string commands;
  for (const CommandText& one : all) commands += one.name + "\t" + one.summary + "\n";
  return {{"loopbench.bash", bash_completion(all)},
          {"_loopbench", zsh_completion(all)},
          {"loopbench.fish", fish_completion(all)},
          {"commands", commands}};
}

}  // namespace loopbench::harness
