#include "daemon/jobs/job_constants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/export/gsf.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Recipe flattened() {
  Recipe recipe;
  recipe.evaluation.surfaces["s"].steps.emplace_back().op = "flatness_reference";
  recipe.evaluation.measurements["t"].surface = "s";
  return recipe;
}

void accept(CalibrationBook& book, const std::string& objective) {
  book.add(objective, [](Calibration& next) {
    next.flatness = FlatnessConstants{0.1, 0.01, next.id + "-flatness.gsf", {}};
    return std::vector<CalibrationFile>{
        {next.flatness->reference, encode_gsf(Plane<float>(4, 3), {"flat", 0.5, 0.5, {}})}};
  });
}

TEST(JobConstants, AreThoseOfTheConfirmedObjective) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  accept(book, "10x");
  accept(book, "50x");
  ResultData confirmed;
  confirmed.objective = "50x";
  ResultData unnamed;
  Recipe recipe;
  recipe.objective = "10x";

  note_constants(recipe, book, {}, confirmed);
  note_constants(recipe, book, {}, unnamed);

  EXPECT_EQ(confirmed.calibration.value().id, "cal-0002");
  EXPECT_EQ(unnamed.calibration.value().id, "cal-0001");
  EXPECT_EQ(confirmed.flatness_reference, nullptr);  // the recipe does not ask
}

TEST(JobConstants, AreNoneWhereNoneWereAccepted) {
  const ScratchDir folder;
  ResultData result;

  note_constants(flattened(), CalibrationBook(folder.path()), {}, result);

  EXPECT_FALSE(result.calibration);
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST(JobConstants, HaveTheReferenceMapWhereTheRecipeAsksForIt) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  accept(book, "");
  ResultData result;
  ResultData without;

  note_constants(flattened(), book, {}, result);
  std::filesystem::remove(folder / "cal-0001-flatness.gsf");
  note_constants(flattened(), book, {}, without);

  ASSERT_NE(result.flatness_reference, nullptr);
  EXPECT_EQ(result.flatness_reference->width(), 4);
  EXPECT_EQ(without.flatness_reference, nullptr);
  ASSERT_THAT(without.warnings, SizeIs(1));
  EXPECT_THAT(without.warnings[0].text, HasSubstr("cal-0001-flatness.gsf"));
}

TEST(JobConstants, OfASimulatorAreNotThoseOfAnInstrument) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  book.add("", [](Calibration& next) {
    next.noise = NoiseConstants{0.05, {}};
    next.noise->origin.simulated = true;
    return std::vector<CalibrationFile>();
  });
  ResultData of_instrument;
  ResultData of_simulator;
  of_simulator.simulated = true;

  note_constants({}, CalibrationBook(folder.path()), {}, of_instrument);
  note_constants({}, CalibrationBook(folder.path()), {}, of_simulator);

  EXPECT_FALSE(of_instrument.calibration);
  ASSERT_THAT(of_instrument.warnings, SizeIs(1));
  EXPECT_EQ(of_instrument.warnings[0].code, "calibration_simulated");
  EXPECT_TRUE(of_simulator.calibration);
}

TEST(JobConstants, HaveTheRepeatabilityOfTheRecipe) {
  const ScratchDir folder;
  const CalibrationBook book(folder.path());
  Recipe recipe;
  recipe.id = "groove";
  ResultData result;
  ResultData failed;

  note_constants(
      recipe, book,
      [](const Recipe& of) {
        return RepeatabilityMap{{of.id + ".height_um", {0.1, 24.0, "s"}}};
      },
      result);
  note_constants(
      recipe, book, [](const Recipe&) -> RepeatabilityMap { throw Error(ErrorCode::kBadInput, "study 7 is damaged"); },
      failed);

  EXPECT_EQ(result.repeatability.at("groove.height_um").sd, 0.1);
  ASSERT_THAT(failed.warnings, SizeIs(1));
  EXPECT_THAT(failed.warnings[0].text, HasSubstr("study 7 is damaged"));
}

}  // namespace
}  // namespace fvd
