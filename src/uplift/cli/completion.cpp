#include <fmt/format.h>

#include "uplift/base/error.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"

// Scripts made from the declared commands: nothing to keep in step by hand.
namespace uplift::cli {
namespace {

void print_bash(const std::vector<Declared>& commands) {
  std::string names;
  for (const Declared& command : commands) names += (names.empty() ? "" : " ") + command.name;
  say("# bash completion of uplift: source <(uplift completion bash)");
  say("_uplift() {");
  say("  local word=\"${COMP_WORDS[COMP_CWORD]}\" options=\"\"");
  say(fmt::format("  if [ \"$COMP_CWORD\" -eq 1 ]; then COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$word\")); return; fi",
                  names));
  say("  case \"${COMP_WORDS[1]}\" in");
  for (const Declared& command : commands) {
    std::string options;
    for (const auto& [option, meaning] : command.options) options += (options.empty() ? "" : " ") + option;
    say(fmt::format("    {}) options=\"{}\" ;;", command.name, options));
  }
  say("  esac");
  say("  if [[ \"$word\" == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$word\")); else COMPREPLY=($(compgen -f -- \"$word\")); "
      "fi");
  say("}");
  say("complete -o filenames -F _uplift uplift");
}

std::string zsh_text(std::string text) {
  for (const char* special : {"[", "]", "'", ":"})
    for (std::size_t at = 0; (at = text.find(special, at)) != text.npos; ++at) text.replace(at, 1, " ");
  return text;
}

void print_zsh(const std::vector<Declared>& commands) {
  say("#compdef uplift\n# zsh completion of uplift: source <(uplift completion zsh)");
  say("_uplift() {\n  local -a commands\n  commands=(");
  for (const Declared& command : commands) say(fmt::format("    '{}:{}'", command.name, zsh_text(command.summary)));
  say("  )\n  if (( CURRENT == 2 )); then _describe command commands; return; fi\n  case \"$words[2]\" in");
  for (const Declared& command : commands) {
    std::string arguments;
    for (const auto& [option, meaning] : command.options) arguments += fmt::format(" '{}[{}]'", option, zsh_text(meaning));
    if (command.takes_file) arguments += " '*:file:_files'";
    say(fmt::format("    {}) shift words; (( CURRENT-- )); _arguments{} ;;", command.name, arguments));
  }
  say("  esac\n}\ncompdef _uplift uplift");
}

}  // namespace

int completion(const std::string& shell, const std::vector<Declared>& commands) {
  if (shell == "bash")
    print_bash(commands);
  else if (shell == "zsh")
    print_zsh(commands);
  else
    throw InputError({"uplift completion", 0}, "", "bash or zsh", "\"" + shell + "\"", nearest_name(shell, {"bash", "zsh"}));
  return Exit::done;
}

}  // namespace uplift::cli
