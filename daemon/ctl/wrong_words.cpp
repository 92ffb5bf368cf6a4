#include "daemon/ctl/wrong_words.hpp"

#include <vector>

#include <CLI/CLI.hpp>

#include "config/nearest_name.hpp"

namespace fvd::ctl {

std::string unknown_command(const CLI::App& app) {
  const CLI::App* parent = &app;
  for (auto inner = parent->get_subcommands(); !inner.empty(); inner = parent->get_subcommands()) {
    parent = inner.front();
  }
  const std::vector<std::string> words = parent->remaining();
  if (parent->get_require_subcommand_min() == 0 || words.empty() || words.front().starts_with('-')) return {};
  std::vector<std::string> names;
  std::string listed;
  for (const CLI::App* command : parent->get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    listed += (listed.empty() ? "" : ", ") + command->get_name();
  }
  return "'" + words.front() + "' is not a command" + (parent == &app ? "" : " of " + parent->get_name()) +
         "; expected one of " + listed + did_you_mean(words.front(), names);
}

std::string unexpected_words(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  std::string text;
  std::string hint;
  for (const std::string& word : words) {
    text += " " + word;
    const std::string name = word.substr(0, word.find('='));
    const bool is_of_all = name.starts_with("--") && app.get_option_no_throw(name) != nullptr;
    if (is_of_all) hint = "; " + name + " stands before the command: fvdctl " + name + " ... COMMAND";
  }
  return text.empty() ? text : "not expected here:" + text + hint;
}

}  // namespace fvd::ctl
