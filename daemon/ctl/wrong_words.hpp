#pragma once

/// What is wrong with a command line whose words are not those of a command, for people.

#include <string>

namespace CLI {
class App;
}

namespace fvd::ctl {

/// Of a word that stands where a command should; empty where that is not what went wrong.
[[nodiscard]] std::string unknown_command(const CLI::App& app);

/// Of words that the command does not take; empty where there are none.
[[nodiscard]] std::string unexpected_words(const CLI::App& app);

}  // namespace fvd::ctl
