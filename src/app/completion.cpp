#include <app/commands.hpp>
#include <app/examples.hpp>
#include <app/starters.hpp>
#include <core/error.hpp>
#include <fmt/format.h>

namespace whirl::app {
namespace {

std::string words(const std::vector<std::string>& list) {
  return fmt::format("{}", fmt::join(list, " "));
}

std::string codes() {
  std::vector<std::string> r;
  for (const auto& c : error_catalogue())
    r.emplace_back(c.code);
  return words(r);
}

std::string example_names() {
  std::vector<std::string> r;
  for (const auto& e : examples())
    r.emplace_back(e.folder);
  return words(r);
}

std::string machine_names() {
  std::vector<std::string> r;
  for (const auto& s : starters())
    r.push_back(s.machine);
  return words(r);
}

std::string bash(const std::vector<CommandInfo>& commands) {
  std::vector<std::string> names;
  std::string cases;
  for (const auto& c : commands) {
    names.push_back(c.name);
    cases += fmt::format("    {}) options=\"{}\" ;;\n", c.name, words(c.options));
  }
  return fmt::format(
      R"(# bash completion of whirl; put it where bash-completion looks, or: source <(whirl completion bash)
_whirl() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command="" options="" i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    [[ ${{COMP_WORDS[i]}} != -* ]] && {{ command=${{COMP_WORDS[i]}}; break; }}
  done
  if [[ -z $command ]]; then
    COMPREPLY=($(compgen -W "{} --help --version" -- "$cur"))
    return
  fi
  case $command in
{}  esac
  case $prev in
    --example) COMPREPLY=($(compgen -W "{}" -- "$cur")); return ;;
    --machine) COMPREPLY=($(compgen -W "{}" -- "$cur")); return ;;
    --output) COMPREPLY=($(compgen -d -- "$cur")); return ;;
    --set|--jobs) return ;;
  esac
  if [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
  elif [[ $command == explain ]]; then
    COMPREPLY=($(compgen -W "{}" -- "$cur"))
  elif [[ $command == completion ]]; then
    COMPREPLY=($(compgen -W "bash fish" -- "$cur"))
  else
    COMPREPLY=($(compgen -f -X '!*.toml' -- "$cur") $(compgen -d -- "$cur"))
  fi
}}
complete -o filenames -F _whirl whirl
)",
      words(names), cases, example_names(), machine_names(), codes());
}

std::string fish(const std::vector<CommandInfo>& commands) {
  std::string r = "# fish completion of whirl\ncomplete -c whirl -f\n";
  for (const auto& c : commands) {
    r += fmt::format("complete -c whirl -n __fish_use_subcommand -a {}\n", c.name);
    for (const auto& o : c.options)
      if (o.starts_with("--"))
        r += fmt::format("complete -c whirl -n '__fish_seen_subcommand_from {}' -l {}\n", c.name,
                         o.substr(2));
    if (c.takes_deck)
      r += fmt::format("complete -c whirl -n '__fish_seen_subcommand_from {}' -F\n", c.name);
  }
  r += fmt::format("complete -c whirl -n '__fish_seen_subcommand_from explain' -a '{}'\n", codes());
  return r;
}

}  // namespace

std::string completion_script(const std::string& shell, const std::vector<CommandInfo>& commands) {
  return shell == "fish" ? fish(commands) : bash(commands);
}

}  // namespace whirl::app
