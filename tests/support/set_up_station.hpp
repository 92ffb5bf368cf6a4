#pragma once

/// A simulated station with the letter F under its lens, set up by an operator who only sees.

#include <filesystem>
#include <string>

#include "daemon/setup/setup.hpp"
#include "sim/plant/plant.hpp"
#include "tests/support/simulated_operator.hpp"

namespace fvd::test {

/// How a station was built.
struct Built {
  bool reversed = false;  ///< the axis
  Mirror mirror;          ///< of the camera
};

/// All eight.
inline std::vector<Built> all_ways_to_build() {
  std::vector<Built> all;
  for (unsigned i = 0; i < 8; ++i) all.push_back({(i & 1U) != 0, {(i & 2U) != 0, (i & 4U) != 0}});
  return all;
}

inline sim::WorldParameters letter_f_world(const Mirror& mirror = {}) {
  sim::WorldParameters world;
  world.surface = sim::SurfaceKind::kLetterF;
  world.base_um = 50.0;
  world.mirror_x = mirror.x;
  world.mirror_y = mirror.y;
  return world;
}

inline sim::PlantOptions letter_f_station(const Built& built) {
  sim::PlantOptions options;
  options.axis = {.encoder_noise_um = 0.01, .settle_noise_um = 0.02, .start_latency_ms = 3.0};
  options.axis.reversed = built.reversed;
  options.world = letter_f_world(built.mirror);
  return options;
}

/// Counts how often the axis moved on an answer that did not say so. context: one thread.
class MotionAudit {
 public:
  explicit MotionAudit(sim::Plant& plant) : plant_(plant), moves_(plant.drive().moves()), lens_um_(lens_um()) {}

  /// To be called after each answer, with whether it was one that moves.
  void note(bool announced) {
    const int moves = plant_.drive().moves();
    const double lens = lens_um();
    if (!announced && (moves != moves_ || std::abs(lens - lens_um_) > 0.5)) ++unattended_;
    moves_ = moves;
    lens_um_ = lens;
  }
  [[nodiscard]] int unattended() const { return unattended_; }

 private:
  [[nodiscard]] double lens_um() { return plant_.axis().true_position_um(HostClock::now()); }

  sim::Plant& plant_;
  int moves_;
  double lens_um_;
  int unattended_ = 0;
};

struct SetUp {
  bool done = false;
  int unattended_moves = 0;
  std::string log;  ///< questions' steps, answers and notes, a line each
  std::filesystem::path written;
};

/// Answers until the setup is done, or has asked more often than anybody would bear.
inline SetUp set_up(sim::Plant& plant, const SetupOptions& options, const std::string& profile) {
  constexpr int kMostQuestions = 80;
  Setup setup(options, {});
  SimulatedOperator person(plant, profile, letter_f_world().artefacts.letter_f);
  MotionAudit audit(plant);
  SetUp result;
  for (int asked = 0; asked < kMostQuestions && !setup.done(); ++asked) {
    const SetupQuestion question = setup.question();
    const std::string answer = person.answer(question);
    result.log += question.step + ": " + answer;
    setup.answer(answer);
    audit.note(moves_the_axis(question, answer));
    result.log += " -> " + (setup.done() ? setup.report() : setup.question().note) + "\n";
  }
  result.done = setup.done();
  result.unattended_moves = audit.unattended();
  if (setup.done()) result.written = setup.written();
  return result;
}

}  // namespace fvd::test
