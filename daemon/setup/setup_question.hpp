#pragma once

/// What the setup asks: the same for a terminal, a script and a page.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace fvd {

/// One kind of answer.
struct SetupChoice {
  std::string word;     ///< to be typed; words in capitals stand for a value, e.g. "up UM" or "ADDRESS"
  std::string meaning;  ///< what happens then
  bool moves = false;   ///< the axis moves on this answer, and on no other
};

struct SetupQuestion {
  std::string step;  ///< name, e.g. "camera"; stable, scripts go by it
  std::string text;
  std::vector<SetupChoice> choices;
  std::string note;               ///< what the last answer came to, or why it was refused; may be empty
  std::filesystem::path picture;  ///< PNG file of what the camera saw last; empty = none yet
};

/// Whether the answer is one that moves the axis: its first word is that of a choice that does.
[[nodiscard]] bool moves_the_axis(const SetupQuestion& question, std::string_view answer);

/// {"step", "text", "choices": [{"word", "meaning", "moves"}], "note", "picture"}.
[[nodiscard]] nlohmann::ordered_json to_json(const SetupQuestion& question);

}  // namespace fvd
