#pragma once

/// From the box to the first trusted step: a state machine of questions and answers that ends in a configuration. It
/// knows neither terminal nor page.

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/setup/setup_question.hpp"
#include "drivers/gige/found_camera.hpp"

namespace fvd {

struct SetupOptions {
  std::filesystem::path file = "fvd.json";  ///< the configuration that is to be written; asked for at the end
  std::filesystem::path drives;             ///< folder of drive profiles
  std::filesystem::path pictures;           ///< existing folder for the camera's picture
  bool simulated = false;                   ///< camera and stage are simulated: stamped into every result
  std::function<std::vector<FoundCamera>()> find_cameras;  ///< asked when the setup begins and on "search"
};

/// The axis moves only within answer(), and only for an answer that its choice announces as moving; so much is enforced
/// where the moves are made. Every answer can be taken back by "back", which asks the step before again and forgets
/// what was decided from there on; where the axis stands is not taken back. context: one thread; request_stop of the
/// token from any.
class Setup {
 public:
  /// Looks for cameras, where options say how, and opens nothing. stop: halts a motion that runs, and makes answer()
  /// return.
  Setup(SetupOptions options, std::stop_token stop);
  ~Setup();
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;

  /// Whether the last answer was refused, or a device failed on it: nothing of it was taken.
  [[nodiscard]] bool refused() const;
  /// The question that is open. Not to be called once done().
  [[nodiscard]] const SetupQuestion& question() const;
  /// Does what the answer says, and asks the next question. An answer that is refused, and a device that fails, leave
  /// the question open, with the reason as its note; where the axis has no reference, that is asked for first. Throws
  /// Error kAborted after a stop request.
  void answer(std::string_view text);

  [[nodiscard]] bool done() const;
  /// The configuration that was written, once done().
  [[nodiscard]] const std::filesystem::path& written() const;
  /// All that was written, in words, once done().
  [[nodiscard]] const std::string& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
