/// What lies outside of the field of view is told before a scan, all of it at once, and in part beside the values.

#include "daemon/evaluation/field_check.hpp"

#include <gmock/gmock.h>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "tests/config/read_fields.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using test::problem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr metrology::Grid kField{240, 180, 0.5, 0.5};  // 120 x 90 um

EvaluationPlan plan_of(const std::string& json) {
  Problems problems;
  EvaluationPlan plan = test::read_plan(json, problems);
  EXPECT_THAT(problems, IsEmpty());
  return plan;
}

Problems outside(const std::string& json) { return outside_field(plan_of(json), kField, "/evaluation"); }

/// The texts of the warnings of one measurement with this region.
std::vector<std::string> warnings_for(const std::string& region) {
  const EvaluationPlan plan = plan_of(R"({"regions": {"r": )" + region + R"(},
    "measurements": {"m": {"kind": "areal", "region": "r", "parameters": ["Sa"]}}})");
  std::vector<std::string> texts;
  for (const auto& warning : partly_outside(plan, plan.measurements.at("m"), kField)) texts.push_back(warning.text);
  return texts;
}

TEST(AFieldOfView, TellsAllThatLiesOutsideAtOnce) {
  EXPECT_THAT(outside(R"({
    "regions": {"right": {"rectangle_um": {"x": 120.3, "y": 10, "width": 5, "height": 5}},
                "below": {"circle_um": {"x": 60, "y": 100, "radius": 9}},
                "corner": {"polygon_um": [[130, 80], [150, 80], [150, 100]]},
                "thin": {"rectangle_um": {"x": 10, "y": 10, "width": 8, "height": 50}, "shrink_um": 5},
                "fine": {"rectangle_um": {"x": 119, "y": 10, "width": 50, "height": 5}}},
    "surfaces": {"cut": {"steps": [{"op": "invert"},
                                   {"op": "crop", "rectangle_um": {"x": 0, "y": 91, "width": 9, "height": 9}}]}},
    "measurements": {"a": {"kind": "step_height", "band_from_to_um": [40, 91], "edges_um": [-1, 20]},
                     "b": {"kind": "step_height", "id": "b", "across": "y", "band_from_to_um": [40, 120]},
                     "c": {"kind": "profile", "from_um": [1, 1], "to_um": [1, 90.5], "parameters": ["Ra"]}}})"),
              UnorderedElementsAre(problem("/evaluation/regions/right/rectangle_um", "120 x 90 um (240 x 180 pixels)"),
                                   problem("/evaluation/regions/below/circle_um", "y 91 to 109"),
                                   problem("/evaluation/regions/corner/polygon_um", "x 130 to 150"),
                                   problem("/evaluation/regions/thin/shrink_um", "leaves no point"),
                                   problem("/evaluation/surfaces/cut/steps/1/rectangle_um", "has no point"),
                                   problem("/evaluation/measurements/a/band_from_to_um", "0 to 90 um"),
                                   problem("/evaluation/measurements/a/edges_um", "0 to 120 um"),
                                   problem("/evaluation/measurements/c/to_um", "at 1, 90.5 um")));
}

TEST(AFieldOfView, RefusesNothingThatStillHasAPointInIt) {
  EXPECT_THAT(outside(R"({
    "regions": {"all": {"rectangle_um": {"x": -50, "y": -50, "width": 1000, "height": 1000}, "shrink_um": 40},
                "cut": {"rectangle_um": {"x": -3, "y": 0, "width": 4, "height": 90}, "shrink_um": 0.4},
                "last": {"rectangle_um": {"x": 119.7, "y": 89.7, "width": 9, "height": 9}},
                "rest": {"not": "all"},
                "high": {"threshold_um": {"above": 5}, "shrink_um": 100},
                "pair": {"union": ["cut", "last"]}},
    "measurements": {"a": {"kind": "step_height", "band_from_to_um": [0, 90], "edges_um": [0, 120]},
                     "c": {"kind": "profile", "from_um": [0, 0], "to_um": [120, 90], "parameters": ["Ra"]}}})"),
              IsEmpty());
}

TEST(AFieldOfView, TellsARegionOfWhichOnlyAPixelsEdgeIsSeen) {
  EXPECT_THAT(outside(R"({"regions": {"r": {"rectangle_um": {"x": 119.8, "y": 0, "width": 9, "height": 9}}}})"),
              ElementsAre(problem("/evaluation/regions/r/rectangle_um", "lies outside")));
}

TEST(APlan, IsRefusedForRegionsThatNoFieldOfViewHas) {
  Problems problems;
  static_cast<void>(test::read_plan(R"({"regions": {
    "left": {"rectangle_um": {"x": -9, "y": 5, "width": 9, "height": 9}},
    "above": {"circle_um": {"x": 5, "y": -6, "radius": 6}},
    "a": {"rectangle_um": {"x": 0, "y": 0, "width": 9, "height": 9}},
    "b": {"rectangle_um": {"x": 9.5, "y": 0, "width": 9, "height": 9}},
    "both": {"intersection": ["a", "b"]}}})",
                                    problems));

  EXPECT_THAT(problems, UnorderedElementsAre(problem("/regions/left/rectangle_um", "left of or above"),
                                             problem("/regions/above/circle_um", "left of or above"),
                                             problem("/regions/both/intersection", "lie apart")));
}

TEST(ARegionPartlyOutside, TellsTheShareOfItsArea) {
  EXPECT_THAT(warnings_for(R"({"rectangle_um": {"x": 90, "y": 60, "width": 40, "height": 40}})"),
              ElementsAre(StartsWith("43.8 % of the region r ")));  // 1 - (30 x 30) / (40 x 40)
  EXPECT_THAT(warnings_for(R"({"circle_um": {"x": 120, "y": 45, "radius": 20}})"),
              ElementsAre(StartsWith("50 % of the region r ")));
  EXPECT_THAT(warnings_for(R"({"polygon_um": [[-10, 0], [10, 0], [-10, 20]]})"),
              // 3 / 4 of it; the samples on the long side count as inside
              ElementsAre(StartsWith("74.9 % of the region r ")));
  EXPECT_THAT(warnings_for(R"({"rectangle_um": {"x": 0, "y": 0, "width": 120, "height": 90}})"), IsEmpty());
  EXPECT_THAT(warnings_for(R"({"rectangle_um": {"x": -0.001, "y": 0, "width": 120, "height": 90}})"), IsEmpty());
}

TEST(ARegionPartlyOutside, WarnsInTheMeasurementsThatRestOnIt) {
  const EvaluationPlan plan = plan_of(R"({
    "regions": {"land": {"rectangle_um": {"x": -10, "y": 0, "width": 20, "height": 20}},
                "twice": {"union": ["land"]}},
    "surfaces": {"flat": {"steps": [{"op": "level", "regions": ["twice"]}]}},
    "measurements": {"on": {"kind": "areal", "surface": "flat", "parameters": ["Sa"]},
                     "off": {"kind": "areal", "id": "off", "parameters": ["Sa"]},
                     "line": {"kind": "profile", "from_um": [10, 1], "to_um": [100, 1], "band_width_um": 8,
                              "parameters": ["Pa"]}}})");
  Surface surface;
  surface.height_m = Plane<float>(240, 180, 1e-6F);
  surface.pitch_x_um = surface.pitch_y_um = 0.5;

  const Evaluation made = evaluate_surface(surface, plan, {}, nullptr);

  const auto is_told = [](const char* what) {
    return Contains(AllOf(Field(&EvaluationWarning::code, "region_partly_outside"),
                          Field(&EvaluationWarning::text, HasSubstr(what))));
  };
  EXPECT_THAT(made.measurements.at("on").warnings, is_told("50 % of the region land "));
  EXPECT_THAT(made.measurements.at("off").warnings, IsEmpty());
  EXPECT_THAT(made.measurements.at("line").warnings, is_told("37.5 % of the profile's band "));
}

}  // namespace
}  // namespace fvd
