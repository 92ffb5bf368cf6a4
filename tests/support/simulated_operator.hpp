#pragma once

/// Somebody who sets up a simulated station whose surface is the letter F, and answers by what there is to see: the
/// lens beside the part, and the picture.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "core/image/mirror.hpp"
#include "daemon/setup/setup.hpp"
#include "sim/artefact/stepped_artefacts.hpp"
#include "sim/plant/plant.hpp"

namespace fvd::test {

class SimulatedOperator {
 public:
  /// profile: of the plant's drive. Plant outlives the operator.
  SimulatedOperator(sim::Plant& plant, std::string profile, sim::LetterF letter)
      : plant_(plant), profile_(std::move(profile)), letter_(letter) {}

  /// What he says to a question; what failed is tried again, "back" never said.
  std::string answer(const SetupQuestion& question) {
    const std::string& step = question.step;
    if (step == "camera") return plant_.camera_address();
    if (step == "line") return "tcp 127.0.0.1:" + std::to_string(plant_.stage_port());
    if (step == "profile") return profile_;
    if (step == "unit") return "1";
    if (step == "scale") return "yes";
    if (step == "travel") return "-1000 1000";
    if (step == "reference") return "home";
    if (step == "jog") {
      before_um_ = lens_um();
      return "jog";
    }
    if (step == "towards") return lens_um() < before_um_ ? "yes" : "no";
    if (step == "upper_limit") return lens_um() < 195.0 ? "up 200" : "here";
    if (step == "lower_limit") return "at -50";
    if (step == "exposure") return tells(question, "exposure") ? "ok" : "auto";
    if (step == "focus") return focus(question);
    if (step == "orientation" || step == "pixel_pitch") {
      if (!tells(question, "picture of")) return "picture";
      return step == "orientation" ? orientation(question.picture.string()) : "100 50 400 50 300";
    }
    if (step == "trial") return tells(question, "points are valid") ? "ok" : "scan 0 120 5";
    return "write";
  }

 private:
  [[nodiscard]] double lens_um() { return plant_.axis().true_position_um(HostClock::now()); }

  static bool tells(const SetupQuestion& question, const char* words) {
    return question.note.find(words) != std::string::npos;
  }

  /// A letter and its land that are equally blurred look alike: beyond the sharpest place they do not. What failed is
  /// tried again.
  std::string focus(const SetupQuestion& question) {
    if (tells(question, "sharpest at")) focused_ = true;
    if (!focused_) return "auto 200";
    return tells(question, "the axis stands at") ? "ok" : "up 15";
  }

  /// Where the picture has fine structure is where it is sharper: the letter's strokes, in one of four positions.
  std::string orientation(const std::string& file) const {
    const cv::Mat picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
    struct Position {
      const char* word;
      Mirror mirror;
    };
    const std::array<Position, 4> all{
        Position{"upright", {}}, {"mirrored", {true, false}}, {"flipped", {false, true}}, {"turned", {true, true}}};
    const Position* best = nullptr;
    double most = 0.0;
    for (const Position& position : all) {
      const double contrast = letter_over_land(picture, position.mirror);
      if (best == nullptr || contrast > most) {
        best = &position;
        most = contrast;
      }
    }
    return best->word;
  }

  /// Mean fine structure on the letter over that on the land around it, were the letter so mirrored.
  [[nodiscard]] double letter_over_land(const cv::Mat& picture, const Mirror& mirror) const {
    double sums[2] = {0.0, 0.0};
    double counts[2] = {0.0, 0.0};
    for (int y = 1; y + 1 < picture.rows; ++y) {
      for (int x = 1; x + 1 < picture.cols; ++x) {
        const double right = x + 0.5 - picture.cols / 2.0;
        const double down = y + 0.5 - picture.rows / 2.0;
        const sim::Level level = sim::level_at(letter_, {mirror.x ? -right : right, mirror.y ? -down : down});
        const double fine = std::abs(2.0 * picture.at<std::uint8_t>(y, x) - picture.at<std::uint8_t>(y, x - 1) -
                                     picture.at<std::uint8_t>(y, x + 1));
        const std::size_t side = level.height_um > 0.0 ? 1 : 0;
        sums[side] += fine;
        counts[side] += 1.0;
      }
    }
    return (sums[1] / counts[1]) / (sums[0] / counts[0]);
  }

  sim::Plant& plant_;
  const std::string profile_;
  const sim::LetterF letter_;
  double before_um_ = 0.0;
  bool focused_ = false;
};

}  // namespace fvd::test
