/// Filters that the optics can hold, and the default settings that it cannot.

#include "daemon/evaluation/filter_suggestion.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/evaluation/field_check.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<bool> fits_of(const FilterSuggestion& suggestion) {
  std::vector<bool> fits;
  for (const auto& row : suggestion.ra) fits.push_back(row.fits());
  return fits;
}

TEST(AFilterSuggestion, TakesTwoWindowsAndAFifthOfTheField) {
  const FilterSuggestion made = suggest_filters({1.0, 1.0, 9.0, 480.0, 360.0});

  EXPECT_EQ(made.s_nesting_um, 20.0);  // 2 x 9 = 18
  EXPECT_EQ(made.l_nesting_um, 50.0);  // 360 / 5 = 72
  EXPECT_EQ(made.areas, 7);
  EXPECT_EQ(made.area.x_um, 65.0);
  EXPECT_EQ(made.area.y_um, 5.0);
  EXPECT_EQ(made.area.width_um, 350.0);
  EXPECT_EQ(made.area.height_um, 350.0);
}

TEST(AFilterSuggestion, NeverHasAnSFilterBelowFivePixels) {
  EXPECT_EQ(suggest_filters({0.5, 0.5, 1.0, 480.0, 360.0}).s_nesting_um, 2.5);
  EXPECT_EQ(suggest_filters({0.5, 0.6, 1.0, 480.0, 360.0}).s_nesting_um, 5.0);
  EXPECT_EQ(suggest_filters({0.1, 0.1, 25.0, 480.0, 360.0}).s_nesting_um, 5.0);
}

TEST(AFilterSuggestion, TellsWhichDefaultSettingsFit) {
  const FilterSuggestion small = suggest_filters({1.0, 1.0, 9.0, 480.0, 360.0});
  EXPECT_THAT(fits_of(small), ElementsAre(true, false, false, false, false));
  EXPECT_TRUE(small.ra[0].fits_along_x);
  EXPECT_FALSE(small.ra[0].fits_along_y);
  EXPECT_THAT(small.ra[1].problem, HasSubstr("480 um long"));
  EXPECT_THAT(fits_of(suggest_filters({1.0, 1.0, 9.0, 399.0, 399.0})), ElementsAre(false, false, false, false, false));
  EXPECT_THAT(fits_of(suggest_filters({1.0, 1.0, 9.0, 300.0, 4000.0})), ElementsAre(true, true, true, false, false));
  const FilterSuggestion coarse = suggest_filters({20.0, 20.0, 9.0, 50000.0, 40000.0});
  EXPECT_THAT(fits_of(coarse), ElementsAre(false, true, true, true, true));
  EXPECT_THAT(coarse.ra[0].problem, HasSubstr("less than 5 pixels"));
  EXPECT_EQ(coarse.ra[4].up_to_ra_um, std::nullopt);
}

TEST(AFilterSuggestion, TakesOneNestingIndexWhereFiveDoNotFitAndSaysSo) {
  const FilterSuggestion made = suggest_filters({1.0, 1.0, 9.0, 90.0, 95.0});

  EXPECT_EQ(made.l_nesting_um, 80.0);
  EXPECT_EQ(made.areas, 1);
  EXPECT_EQ(made.area.x_um, 5.0);
  EXPECT_EQ(made.area.y_um, 7.0);
  EXPECT_THAT(made.notes, Contains(HasSubstr("1 time(s)")));
}

TEST(AFilterSuggestion, HasNoLFilterWhereTheFieldHoldsNoneAboveS) {
  const FilterSuggestion made = suggest_filters({1.0, 1.0, 9.0, 20.0, 19.0});

  EXPECT_EQ(made.l_nesting_um, std::nullopt);
  EXPECT_EQ(made.area.width_um, 20.0);
  EXPECT_THAT(made.notes, Contains(HasSubstr("no L filter")));
  EXPECT_THAT(suggestion_json(made), Not(HasSubstr("\"L\"")));
}

TEST(AFilterSuggestion, IsAnEvaluationThatARecipeTakesAndASurfaceGives) {
  const FilterSuggestion made = suggest_filters({0.5, 0.5, 5.0, 120.0, 90.0});
  Problems problems;
  const EvaluationPlan plan =
      test::read_plan(nlohmann::json::parse(suggestion_json(made))["evaluation"].dump(), problems);
  ASSERT_THAT(problems, IsEmpty());
  EXPECT_THAT(outside_field(plan, {240, 180, 0.5, 0.5}, ""), IsEmpty());
  Surface surface;
  surface.height_m = Plane<float>(240, 180, 1e-6F);
  surface.pitch_x_um = surface.pitch_y_um = 0.5;

  const EvaluatedMeasurement texture = evaluate_surface(surface, plan, {}, nullptr).measurements.at("texture");

  EXPECT_EQ(texture.reason, "");
  EXPECT_EQ(texture.valid_fraction, 1.0);
  EXPECT_NEAR(texture.values.at("Sa_um").value.value_or(1.0), 0.0, 1e-9);
}

TEST(AFilterSuggestion, IsPrintedAsATable) {
  const std::string text = suggestion_text(suggest_filters({1.0, 1.0, 9.0, 480.0, 360.0}));

  EXPECT_THAT(text, HasSubstr("S filter    20 um\nL filter    50 um\narea        350 x 350 um at 65, 5 um\n"));
  EXPECT_THAT(text, HasSubstr("  to 0.02 um      80 um           400 um                along x\n"));
  EXPECT_THAT(text,
              HasSubstr("  above 10 um     8000 um         40000 um              no: the field is 480 um long\n"));
}

}  // namespace
}  // namespace fvd
