#include "daemon/setup/setup_question.hpp"

#include <algorithm>

namespace fvd {

namespace {

std::string_view first_word(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  return text.substr(0, text.find_first_of(" \t\r"));
}

}  // namespace

bool moves_the_axis(const SetupQuestion& question, std::string_view answer) {
  const std::string_view word = first_word(answer);
  return std::any_of(question.choices.begin(), question.choices.end(), [word](const SetupChoice& choice) {
    return choice.moves && !word.empty() && first_word(choice.word) == word;
  });
}

nlohmann::ordered_json to_json(const SetupQuestion& question) {
  nlohmann::ordered_json choices = nlohmann::ordered_json::array();
  for (const SetupChoice& choice : question.choices) {
    choices.push_back({{"word", choice.word}, {"meaning", choice.meaning}, {"moves", choice.moves}});
  }
  return {{"step", question.step},
          {"text", question.text},
          {"choices", std::move(choices)},
          {"note", question.note},
          {"picture", question.picture.string()}};
}

}  // namespace fvd
