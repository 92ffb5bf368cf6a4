/// Where measurements looked, as lines for pictures.

#include "daemon/evaluation/measured_section.hpp"

#include <array>
#include <cmath>

#include <gmock/gmock.h>

namespace fvd {
namespace {

using Region = CrossSection::Region;
using testing::ElementsAre;

metrology::HeightField field_of(int width, int height, double pitch_x_um, double pitch_y_um) {
  metrology::HeightField field;
  field.z_um = Plane<double>(width, height);
  field.pitch_x_um = pitch_x_um;
  field.pitch_y_um = pitch_y_um;
  return field;
}

/// Columns [first, end) and rows alike are in it.
metrology::Region block(const metrology::HeightField& field, int first_column, int end_column, int first_row,
                        int end_row) {
  metrology::Region region(field.width(), field.height());
  for (int y = first_row; y < end_row; ++y) {
    for (int x = first_column; x < end_column; ++x) region.at(x, y) = 1;
  }
  return region;
}

TEST(GrooveSection, RunsThroughTheMiddleOfTheBand) {
  const auto field = field_of(300, 60, 1.0, 2.0);
  metrology::GrooveSettings settings;
  settings.band = metrology::FromTo{20.0, 100.0};

  const CrossSection section = groove_section(field, settings, {105.0, 195.0});

  EXPECT_EQ(section, (CrossSection{
                         0.0, 60.0, 300.0, 60.0, 80.0, {{"A", 15.0, 75.0}, {"B", 225.0, 285.0}, {"C", 135.0, 165.0}}}));
}

TEST(GrooveSection, RunsDownwardsOverTheWholeFieldForAGrooveAcrossY) {
  const auto field = field_of(300, 60, 1.0, 2.0);
  metrology::GrooveSettings settings;
  settings.across = metrology::Across::kY;

  const CrossSection section = groove_section(field, settings, {50.0, 80.0});

  EXPECT_DOUBLE_EQ(section.from_x_um, 150.0);
  EXPECT_DOUBLE_EQ(section.to_x_um, 150.0);
  EXPECT_DOUBLE_EQ(section.from_y_um, 0.0);
  EXPECT_DOUBLE_EQ(section.to_y_um, 120.0);
  EXPECT_DOUBLE_EQ(section.band_width_um, 300.0);
}

TEST(RegionsSection, RunsThroughBothCentresToTheBorder) {
  const auto field = field_of(40, 20, 2.0, 2.0);
  const auto left = block(field, 4, 10, 5, 15);
  const auto right = block(field, 20, 36, 5, 15);
  const std::array regions{SectionRegion{"land", &left}, SectionRegion{"rake", &right}};

  const CrossSection section = regions_section(field, regions);

  EXPECT_DOUBLE_EQ(section.from_x_um, 0.0);
  EXPECT_DOUBLE_EQ(section.from_y_um, 20.0);
  EXPECT_DOUBLE_EQ(section.to_x_um, 80.0);
  EXPECT_DOUBLE_EQ(section.band_width_um, 2.0);
  EXPECT_THAT(section.regions, ElementsAre(Region{"land", 8.0, 20.0}, Region{"rake", 40.0, 72.0}));
}

TEST(RegionsSection, TurnsRoundWhereTheFirstRegionIsBehind) {
  const auto field = field_of(40, 20, 2.0, 2.0);
  const auto top = block(field, 4, 10, 2, 6);
  const auto bottom = block(field, 4, 10, 12, 18);
  const std::array regions{SectionRegion{"b", &bottom}, SectionRegion{"t", &top}};

  const CrossSection section = regions_section(field, regions);

  EXPECT_DOUBLE_EQ(section.from_y_um, 40.0);
  EXPECT_DOUBLE_EQ(section.to_y_um, 0.0);
  EXPECT_DOUBLE_EQ(section.from_x_um, 14.0);
  EXPECT_THAT(section.regions, ElementsAre(Region{"b", 4.0, 16.0}, Region{"t", 28.0, 36.0}));
}

TEST(RegionsSection, OfOneCentreIsARow) {
  const auto field = field_of(40, 20, 2.0, 2.0);
  const auto all = block(field, 0, 40, 0, 20);
  const auto inner = block(field, 10, 30, 5, 15);
  const std::array regions{SectionRegion{"all", &all}, SectionRegion{"inner", &inner}};

  const CrossSection section = regions_section(field, regions);

  EXPECT_DOUBLE_EQ(section.length_um(), 80.0);
  EXPECT_THAT(section.regions, ElementsAre(Region{"all", 0.0, 80.0}, Region{"inner", 20.0, 60.0}));
}

TEST(EdgeSection, CrossesTheEdgeInItsMiddleFromLeftToRight) {
  metrology::CuttingEdge edge;
  PlannedMeasurement planned;
  planned.flank_um = {10.0, 50.0};
  planned.sections_every_um = 8.0;
  EXPECT_FALSE(edge_section(edge, planned).has_value());
  edge.direction_deg = 90.0;  // down the image
  edge.sections.resize(3);
  edge.sections[1].x_um = 200.0;
  edge.sections[1].y_um = 30.0;

  const CrossSection section = edge_section(edge, planned).value();

  EXPECT_NEAR(section.from_x_um, 135.0, 1e-9);
  EXPECT_NEAR(section.to_x_um, 265.0, 1e-9);
  EXPECT_NEAR(section.from_y_um, 30.0, 1e-9);
  EXPECT_NEAR(section.to_y_um, 30.0, 1e-9);
  EXPECT_EQ(section.band_width_um, 8.0);
  EXPECT_THAT(section.regions, ElementsAre(Region{"flank", 15.0, 55.0}, Region{"flank", 75.0, 115.0}));
}

}  // namespace
}  // namespace fvd
