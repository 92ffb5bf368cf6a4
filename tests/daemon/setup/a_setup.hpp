#pragma once

/// A simulated station in the middle of its setup.

#include <string>

#include "daemon/setup/setup.hpp"
#include "gtest/gtest.h"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/set_up_station.hpp"

namespace fvd {

class ASetup : public testing::Test {
 protected:
  ASetup() : ASetup(test::letter_f_station({}), FVD_SOURCE_DIR "/config/drives/oriental-az.json") {}
  /// older: configuration that is there already; empty = none.
  ASetup(const sim::PlantOptions& built, const std::string& profile, const std::string& older = {})
      : plant_(built),
        person_(plant_, profile, test::letter_f_world().artefacts.letter_f),
        setup_((write_older(older), options()), {}) {}

  [[nodiscard]] SetupOptions options() const {
    return {folder_ / "fvd.json", FVD_SOURCE_DIR "/config/drives", folder_.path(), true, {}};
  }
  void write_older(const std::string& text) const {
    if (!text.empty()) test::write_text(folder_ / "fvd.json", text);
  }

  void answer(const std::string& text) {
    const bool moves = moves_the_axis(setup_.question(), text);
    setup_.answer(text);
    audit_.note(moves);
  }
  /// Answers as the operator would until that step is asked.
  void come_to(const std::string& step) {
    for (int i = 0; i < 40 && setup_.question().step != step; ++i) answer(person_.answer(setup_.question()));
    ASSERT_EQ(setup_.question().step, step) << setup_.question().note;
  }
  [[nodiscard]] std::string step() const { return setup_.question().step; }
  [[nodiscard]] std::string note() const { return setup_.question().note; }
  /// The question's text tells so.
  [[nodiscard]] bool says(const std::string& words) const {
    return setup_.question().text.find(words) != std::string::npos;
  }
  /// The answer is refused with these words, the question stays open, and nothing has moved.
  void expect_refused(const std::string& text, const std::string& words) {
    const std::string before = step();
    const int moves = plant_.drive().moves();
    answer(text);
    EXPECT_EQ(step(), before) << text;
    EXPECT_NE(note().find(words), std::string::npos) << text << ": " << note();
    EXPECT_EQ(plant_.drive().moves(), moves) << text;
  }

  test::ScratchDir folder_;
  sim::Plant plant_;
  test::MotionAudit audit_{plant_};
  test::SimulatedOperator person_;
  fvd::Setup setup_;  // testing::Test has a private one
};

}  // namespace fvd
