#include "core/metrology/profile/default_settings.hpp"

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

TEST(DefaultSettings, AreChosenByTheToleranceOfRa) {
  EXPECT_EQ(default_settings_for(0.0).nesting_um, 80.0);
  EXPECT_EQ(default_settings_for(0.02).evaluation_length_um, 400.0);
  EXPECT_EQ(default_settings_for(0.021).nesting_um, 250.0);
  EXPECT_EQ(default_settings_for(0.1).evaluation_length_um, 1250.0);
  EXPECT_EQ(default_settings_for(2.0).nesting_um, 800.0);
  EXPECT_EQ(default_settings_for(2.1).evaluation_length_um, 12500.0);
  EXPECT_EQ(default_settings_for(10.0).nesting_um, 2500.0);
  EXPECT_EQ(default_settings_for(1000.0).nesting_um, 8000.0);
  EXPECT_EQ(default_settings_for(11.0).evaluation_length_um, 40000.0);
  EXPECT_EQ(default_settings_table().size(), 5u);
}

TEST(DefaultSettings, AreThoseOfTheRowAlone) {
  const DefaultSettings& row = default_settings_for(1.0);

  EXPECT_TRUE(are_default_settings(row, 800.0, 4000.0, 5));
  EXPECT_FALSE(are_default_settings(row, 80.0, 400.0, 5));
  EXPECT_FALSE(are_default_settings(row, 800.0, 4000.0, 4));
  EXPECT_FALSE(are_default_settings(row, 800.0, 2400.0, 5));
}

TEST(DefaultSettings, ArePartOfANameWhereTheyAreOthers) {
  EXPECT_EQ(label_with_settings("Ra", true, 800.0, 5), "Ra");
  EXPECT_EQ(label_with_settings("Ra", false, 80.0, 5), "Ra (0.08 mm x 5)");
}

}  // namespace
}  // namespace fvd::metrology
