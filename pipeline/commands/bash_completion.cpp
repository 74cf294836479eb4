#include "pipeline/commands/bash_completion.hpp"

#include "io/read_mesh.hpp"
#include "pipeline/commands/help.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Bash splits words at `=`, too: the line is split here again, and what is offered begins after the last
/// `=`.
constexpr const char* machinery = R"bash(
_aeroloom_words() {  # the words $1 that begin like the word at hand
  COMPREPLY+=($(compgen -W "$1" -- "$word"))
}

_aeroloom_files() {  # folders, and files that end like one of the arguments; all files without arguments
  local file ending
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [[ $# -eq 0 || -d ${file/#\~\//$HOME/} ]]; then
      COMPREPLY+=("$file")
      continue
    fi
    for ending; do
      [[ $file == *"$ending" ]] && COMPREPLY+=("$file") && break
    done
  done < <(compgen -f -- "$word")
}

_aeroloom_assignment() {  # section.key=value
  if [[ $word != *=* ]]; then
    compopt -o nospace 2>/dev/null
    _aeroloom_words "$(_aeroloom_keys)"
    return
  fi
  local key=${word%%=*}
  word=${word#*=}
  _aeroloom_key_values "$key"
}

_aeroloom() {
  local line=${COMP_LINE:0:COMP_POINT} words=() word whole command='' before='' places=0 i
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=('')
  word=${words[-1]}
  whole=$word
  for ((i = 1; i < ${#words[@]} - 1; ++i)); do
    if _aeroloom_takes_value "$command" "${words[i]}"; then
      if ((i + 1 < ${#words[@]} - 1)); then ((++i)); else before=${words[i]}; fi
    elif [[ ${words[i]} != -* ]]; then
      if [[ -z $command ]]; then command=${words[i]}; else ((++places)); fi
    fi
  done
  COMPREPLY=()
  if [[ -z $before && $word == --*=* ]]; then
    before=${word%%=*}
    word=${word#*=}
  fi
  if [[ -n $before ]]; then
    _aeroloom_option_values "$command" "$before"
  elif [[ $word == -* ]]; then
    _aeroloom_words "$(_aeroloom_options "$command")"
  elif [[ -z $command ]]; then
    _aeroloom_words "$(_aeroloom_commands)"
  else
    _aeroloom_places "$command" "$places"
  fi
  # Where bash does not break words at `=`, it replaces what stands before it, too.
  [[ $COMP_WORDBREAKS == *=* ]] || COMPREPLY=("${COMPREPLY[@]/#/${whole%"$word"}}")
}

complete -F _aeroloom aeroloom
)bash";

/// How bash completes a value of this type, as --help names it.
std::string action_for(const std::string& type) {
  if (type.starts_with(assignment)) return "_aeroloom_assignment";
  if (type.starts_with(file_kind::of_case)) return "_aeroloom_files .yaml .yml";
  if (type.starts_with(file_kind::mesh))
    return fmt::format("_aeroloom_files {}", fmt::join(io::readable_extensions(), " "));
  if (type.starts_with(file_kind::step)) return "_aeroloom_files .step .stp";
  if (type.starts_with(file_kind::json)) return "_aeroloom_files .json";
  if (type.starts_with(file_kind::any)) return "_aeroloom_files";
  if (!type.starts_with("{")) return ":";
  std::string names = type.substr(1, type.find('}') - 1);
  std::replace(names.begin(), names.end(), ',', ' ');
  return fmt::format("_aeroloom_words '{}'", names);
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// The body of a function of bash that decides by its arguments.
class Cases {
public:
  Cases(const char* name, const char* subject)
      : _text(fmt::format("{}() {{\n  case {} in\n", name, subject)) {}
  void add(const std::string& pattern, const std::string& action) {
    _text += fmt::format("    {}) {} ;;\n", pattern, action);
  }
  std::string take(const char* otherwise = ":") {
    return _text + fmt::format("    *) {} ;;\n  esac\n}}\n", otherwise);
  }

private:
  std::string _text;
};

std::string echo(const std::vector<std::string>& words) {
  return fmt::format("echo '{}'", fmt::join(words, " "));
}

std::vector<std::string> all_names(const CLI::App& command) {
  std::vector<std::string> all;
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string> names = names_of(*option);
    all.insert(all.end(), names.begin(), names.end());
  }
  return all;
}

/// Tables of the arguments that each command takes, and the program itself under an empty name.
std::string tables(const std::vector<const CLI::App*>& commands) {
  Cases options("_aeroloom_options", "$1"), valued("_aeroloom_takes_value", "\"$1 $2\""),
      values("_aeroloom_option_values", "\"$1 $2\""), places("_aeroloom_places", "\"$1 $2\"");
  std::vector<std::string> names;
  for (const CLI::App* command : commands) {
    const std::string name = command->get_parent() == nullptr ? "" : command->get_name();
    if (!name.empty()) names.push_back(name);
    options.add("'" + name + "'", echo(all_names(*command)));
    int place = 0;
    for (const CLI::Option* option : command->get_options()) {
      const std::string action = action_for(option->get_type_name());
      if (option->get_positional()) places.add(fmt::format("'{} {}'", name, place++), action);
      if (!takes_value(*option)) continue;
      for (const std::string& typed : names_of(*option)) {
        valued.add(fmt::format("'{} {}'", name, typed), "return 0");
        values.add(fmt::format("'{} {}'", name, typed), action);
      }
    }
  }
  return fmt::format("_aeroloom_commands() {{\n  {}\n}}\n", echo(names)) + options.take() +
         valued.take("return 1") + values.take() + places.take();
}

/// Names that users make up are not offered, but values after them are.
std::string key_tables(const std::vector<cases::KeyInfo>& keys) {
  const std::string made_up = std::string(".") + cases::made_up_name + ".";
  std::vector<std::string> offered;
  Cases values("_aeroloom_key_values", "$1");
  for (const cases::KeyInfo& key : keys) {
    if (key.has_keys_below()) continue;
    std::string pattern = key.path;
    const std::size_t at = pattern.find(made_up);
    if (at != std::string::npos) pattern.replace(at, made_up.size(), ".*.");
    if (at == std::string::npos) offered.push_back(key.path + "=");
    if (!key.choices.empty()) {
      values.add(pattern, fmt::format("_aeroloom_words '{}'", fmt::join(key.choices, " ")));
    } else if (key.kind == cases::KeyKind::flag) {
      values.add(pattern, "_aeroloom_words 'true false'");
    } else if (key.name() == "file" || key.name() == "directory") {
      values.add(pattern, "_aeroloom_files");
    }
  }
  return fmt::format("_aeroloom_keys() {{\n  {}\n}}\n", echo(offered)) + values.take();
}

}  // namespace

std::string bash_completion(const CLI::App& program, const std::vector<cases::KeyInfo>& keys) {
  std::vector<const CLI::App*> commands = program.get_subcommands({});
  commands.push_back(&program);
  return "# Completion of aeroloom in bash, made by `aeroloom completion bash`.\n" + tables(commands) +
         key_tables(keys) + machinery;
}

}  // namespace aeroloom::pipeline
