#include "daemon/store/curve_width_table.hpp"

#include <filesystem>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

class ACurveWidthTable : public ::testing::Test {
 protected:
  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_.path() / "jobs.db";
  std::unique_ptr<JobStore> store_ = std::make_unique<JobStore>(file_);
};

TEST_F(ACurveWidthTable, RemembersTheWidthOfARecipesFocusCurve) {
  Recipe recipe;
  recipe.id = "part";
  recipe.step_um = 4.0;
  {
    CurveWidthTable& widths = store_->curve_widths();
    EXPECT_FALSE(widths.find(recipe).has_value());
    widths.learn(recipe, 40.0, 7);
    widths.learn(recipe, 43.0, 2);
    const auto learnt = widths.find(recipe);
    ASSERT_TRUE(learnt.has_value());
    EXPECT_EQ(learnt->scans, 2);
    EXPECT_NEAR(learnt->width_um, 41.5, 1e-3);
    for (int i = 0; i < 40; ++i) widths.learn(recipe, 30.0, 64);
    EXPECT_NEAR(widths.find(recipe)->width_um, 30.0, 0.01) << "a microscope changes";
  }
  const double told_um = store_->curve_widths().find(recipe)->width_um;
  store_.reset();
  store_ = std::make_unique<JobStore>(file_);  // as a new process would see it
  const auto kept = store_->curve_widths().find(recipe);
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(kept->width_um, told_um) << "to the bit, or a restart would change the next heights";
  EXPECT_EQ(kept->scans, 5);
  EXPECT_EQ(kept->most_bin_slices, 2) << "one of the scans had heights near the ends";
}

TEST_F(ACurveWidthTable, ForgetsAWidthWhoseSettingsHaveChanged) {
  Recipe recipe;
  recipe.id = "part";
  const auto after = [&](const std::function<void(Recipe&)>& change) {
    store_->curve_widths().learn(recipe, 40.0, 64);
    Recipe changed = recipe;
    change(changed);
    return store_->curve_widths().find(changed).has_value();
  };
  EXPECT_TRUE(after([](Recipe& changed) { changed.focus.min_prominence = 0.2; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.id = "other"; }));
  EXPECT_TRUE(store_->curve_widths().find(recipe).has_value()) << "that of the others is not forgotten over it";
  Recipe coarse = recipe;
  coarse.step_um = 7.0;
  EXPECT_FALSE(store_->curve_widths().find(coarse).has_value());
  EXPECT_TRUE(store_->curve_widths().find(recipe).has_value()) << "nor over a question for other settings";
  store_->curve_widths().learn(coarse, 50.0, 64);
  EXPECT_FALSE(store_->curve_widths().find(recipe).has_value()) << "a row a recipe";
  EXPECT_NEAR(store_->curve_widths().find(coarse)->width_um, 50.0, 1e-3);
  EXPECT_FALSE(after([](Recipe& changed) { changed.step_um = 5.0; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.start_um = -20.0; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.slices = 31; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.focus.window_px = 11; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.focus.window = FocusWindow::kBox; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.focus.distance_px = 3; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.focus.focus_operator = FocusOperator::kTenengrad; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.camera.offset_x = 8; }));
  EXPECT_FALSE(after([](Recipe& changed) { changed.camera.width = 100; }));
}

}  // namespace
}  // namespace fvd
