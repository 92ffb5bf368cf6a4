#include <cstdint>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/report/hole_reasons.hpp"
#include "daemon/report/measurement_pictures.hpp"
#include "daemon/report/surface_digest.hpp"
#include "daemon/report/surface_pictures.hpp"
#include "tests/daemon/report/sample_report.hpp"

namespace fvd {
namespace {

struct Size {
  unsigned width = 0;
  unsigned height = 0;
};

/// From the head of a PNG.
Size size_of(const std::string& png) {
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  const auto number = [&png](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(png.at(i));
    return value;
  };
  return {number(16), number(20)};
}

TEST(SurfacePictures, HaveTheProportionsOfTheField) {
  const Surface wide = test::groove_surface(160, 40);
  const Surface high = test::groove_surface(40, 160);

  const Size of_wide = size_of(sigma_png(picture_surface(wide)));
  const Size of_high = size_of(sigma_png(picture_surface(high)));

  // 520 points for the longer side, two pixels a point, and what stands around the field.
  EXPECT_EQ(of_wide.width, 2U * 640U);
  EXPECT_EQ(of_high.width, 2U * 300U) << "the least, for the title";
  EXPECT_EQ(of_high.height - of_wide.height, 2U * (520U - 130U));
}

TEST(MeasurementPictures, ShowWhatWasNotMeasuredAndEveryNotch) {
  const Surface surface = test::groove_surface();
  const PictureSurface picture = picture_surface(surface);
  Evaluation evaluation;
  evaluation.order = {"edge"};
  EvaluatedMeasurement& edge = evaluation.measurements["edge"];
  edge.kind = "cutting_edge";
  edge.main_value = "radius_um";
  edge.values["radius_um"] = test::value_of(10.0, "um", 0.2);
  edge.details = R"({"sections":[{"along_um":0,"radius_um":10},{"along_um":10,"radius_um":11}]})";
  const std::string clean = edge_png(picture, evaluation);
  EXPECT_TRUE(is_cutting_edge(edge));
  EXPECT_TRUE(clean == edge_png(picture, evaluation)) << "the same bytes";

  edge.details = R"({"sections":[{"along_um":0,"radius_um":10},{"along_um":10,"unmeasured":"hole"}]})";
  EXPECT_FALSE(clean == edge_png(picture, evaluation));
  edge.details = R"({"sections":[{"along_um":0,"radius_um":10},{"along_um":10,"radius_um":11}],
      "chipping":{"notches":[{"along_um":4,"depth_um":3,"width_um":2}]}})";
  EXPECT_FALSE(clean == edge_png(picture, evaluation));
  for (const char* nothing : {"", "[]", R"({"sections":7})", R"({"sections":[]})", R"({"sections":[{"x_um":1}]})"}) {
    edge.details = nothing;
    EXPECT_FALSE(is_cutting_edge(edge)) << nothing;
  }
}

TEST(MeasurementPictures, ShowACrossSectionUnderItsNameAndTheImageWhereThereIsOne) {
  const Surface surface = test::groove_surface();
  const PictureSurface picture = picture_surface(surface);
  const Evaluation evaluation = test::sample_evaluation();
  const EvaluatedMeasurement& step = evaluation.measurements.at("step");
  EXPECT_FALSE(profile_png(picture, "step", step) == profile_png(picture, "other", step));

  Plane<std::uint16_t> grey(surface.width(), surface.height(), 100);
  PictureTexture texture;
  const std::string none = texture_view_png(picture, texture);
  texture.grey = grey.view();
  EXPECT_FALSE(none == texture_view_png(picture, texture));
  const std::string dark = texture_view_png(picture, texture);
  texture.max_grey = 4095;
  EXPECT_FALSE(dark == texture_view_png(picture, texture)) << "the same level is darker where more fit";
}

TEST(MeasurementPictures, DrawWhatWasFittedAndTheEdgesLine) {
  const Surface surface = test::groove_surface();
  const PictureSurface picture = picture_surface(surface);
  Evaluation evaluation = test::sample_evaluation();
  EvaluatedMeasurement& step = evaluation.measurements.at("step");
  const std::string without = profile_png(picture, "step", step);
  step.cross_section->fit = {{{16.0, 300.0}, {120.0, 120.0}}};
  step.cross_section->fit_name = "fitted lines";
  const std::string with = profile_png(picture, "step", step);
  EXPECT_FALSE(without == with);
  step.cross_section->fit.front().z_um = {119.0, 119.0};
  EXPECT_FALSE(with == profile_png(picture, "step", step)) << "where it lies";
  step.cross_section->fit.front().z_um.pop_back();
  EXPECT_TRUE(profile_png(picture, "step", step).starts_with("\x89PNG")) << "half a line";

  Evaluation edges;
  edges.order = {"edge"};
  EvaluatedMeasurement& edge = edges.measurements["edge"];
  edge.kind = "cutting_edge";
  edge.main_value = "radius_um";
  const auto drawn = [&](const std::string& chipping) {
    edge.details =
        R"({"sections":[{"along_um":0,"radius_um":10},{"along_um":50,"radius_um":11}],"chipping":)" + chipping + "}";
    return edge_png(picture, edges);
  };
  const std::string bare = drawn(R"({"notches":[]})");
  const std::string line = drawn(R"({"notches":[],"line":{"from_um":0,"every_um":10,"missing_um":[0,1,0.5,0]}})");
  EXPECT_FALSE(bare == line);
  EXPECT_FALSE(line == drawn(R"({"notches":[],"line":{"from_um":0,"every_um":10,"missing_um":[0,1,null,0]}})"));
  EXPECT_TRUE(bare == drawn(R"({"notches":[],"line":[]})")) << "no line";
}

TEST(SurfacePictures, AreTheSameBytesForTheSameSurface) {
  const Surface surface = test::groove_surface();
  const PictureSurface picture = picture_surface(surface);

  EXPECT_TRUE(sigma_png(picture) == sigma_png(picture));
  EXPECT_TRUE(holes_png(picture) == holes_png(picture));
  EXPECT_TRUE(view3d_png(picture) == view3d_png(picture));
  EXPECT_EQ(size_of(view3d_png(picture)).width, 1200U);
}

TEST(SurfacePictures, ShowOneHoleOfALargeField) {
  Surface surface = test::groove_surface(2600, 30);
  const std::string before = holes_png(picture_surface(surface));

  surface.mask.at(2000, 25) = mask_reason::kSecondPeak;

  EXPECT_FALSE(before == holes_png(picture_surface(surface)));
}

TEST(SurfacePictures, DoWithoutMaskSigmaAndPitch) {
  const Surface surface = test::groove_surface(12, 9);
  PictureSurface picture;
  picture.height_m = surface.height_m.view();

  EXPECT_GT(size_of(sigma_png(picture)).width, 0U);
  EXPECT_GT(size_of(holes_png(picture)).width, 0U);
  EXPECT_GT(size_of(view3d_png(picture)).width, 0U);
}

TEST(HoleReasons, HaveAColourEach) {
  std::uint32_t bits = 0;
  std::set<std::uint32_t> colours;
  for (const HoleReason& reason : hole_reasons()) {
    EXPECT_EQ(bits & reason.bit, 0U) << reason.name;
    bits |= reason.bit;
    EXPECT_TRUE(colours.insert(reason.colour).second) << reason.name;
  }

  EXPECT_EQ(bits, 0x5FFFU) << "all bits that mean something";
}

TEST(SurfaceDigest, IsOfTheHeightsAlone) {
  // sha256sum of 00 00 80 3f 00 00 c0 7f 00 00 00 40 00 00 80 bf
  Plane<float> heights(2, 2);
  heights.at(0, 0) = 1.0F;
  heights.at(1, 0) = -std::numeric_limits<float>::quiet_NaN();
  heights.at(0, 1) = 2.0F;
  heights.at(1, 1) = -1.0F;

  EXPECT_EQ(surface_sha256(heights.view()), "60608f33266a9979002b8fb817e79d8c22cddedb49530151ce0898a9f5b8d771");
}

}  // namespace
}  // namespace fvd
