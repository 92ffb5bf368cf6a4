/// Plans that cannot be carried out are refused, all mistakes at once, each with its place.

#include "daemon/evaluation/check_plan.hpp"

#include <gmock/gmock.h>

#include "tests/config/read_fields.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using test::problem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

Problems problems_of(const std::string& json) {
  Problems problems;
  static_cast<void>(test::read_plan(json, problems));
  return problems;
}

TEST(APlan, OfTheManualIsAccepted) {
  EXPECT_THAT(problems_of(R"({
    "surfaces": {
      "primary": {"from": "measured", "steps": [
        {"op": "mask_sigma", "max_sigma_um": 1.5},
        {"op": "outliers", "window_px": 7, "limit": 6.0},
        {"op": "level", "form": "plane", "regions": ["land"]}]},
      "texture": {"from": "primary", "steps": [
        {"op": "form", "form": "polynomial", "degree": 2},
        {"op": "filter", "side": "S", "nesting_um": 10.0, "method": "gaussian"},
        {"op": "filter", "side": "L", "nesting_um": 80.0, "method": "gaussian_regression_2", "robust": true}]}},
    "regions": {
      "land": {"rectangle_um": {"x": 20, "y": 20, "width": 140, "height": 280}},
      "rake": {"polygon_um": [[200, 20], [330, 20], [330, 330], [200, 330]], "shrink_um": 5},
      "bottom": {"threshold_um": {"above": 45, "below": 55}, "largest": true},
      "rest": {"not": "land"},
      "both": {"union": ["land", "rake"]}},
    "measurements": {
      "step": {"kind": "step_height", "surface": "primary", "method": "iso5436_a1", "across": "x",
               "band_from_to_um": [40, 320], "traces": 9, "limits": {"height_um": {"lower": 49.5, "upper": 50.5}}},
      "offset": {"kind": "step_between", "surface": "primary", "lower": "land", "upper": "rake"},
      "stairs": {"kind": "levels", "id": "lvl", "regions": ["land", "rake"], "limits": {"rake-land_um": {"lower": 1}}},
      "texture": {"kind": "areal", "surface": "texture", "region": "land", "parameters": ["Sa", "Smr1"],
                  "limits": {"Sa_um": {"upper": 0.8}, "Smr1_percent": {"upper": 20}}},
      "trace": {"kind": "profile", "from_um": [10, 180], "to_um": [470, 180], "parameters": ["Ra", "RSm"]},
      "edge": {"kind": "cutting_edge", "region": "rake", "flank_um": [15, 80], "chipping": {"min_depth_um": 3.0},
               "limits": {"radius_um": {"lower": 8, "upper": 12}, "K": {"lower": 0.8}, "chipping_max_um": {"upper": 5}}}},
    "decision": {"rule": "iso14253_1", "probability": 0.95}})"),
              IsEmpty());
}

TEST(APlan, IsRefusedForNumbersThatTheArithmeticHasNot) {
  EXPECT_THAT(problems_of(R"({"decision": {"probability": 0.5}})"),
              ElementsAre(problem("/decision/probability", "above 0.5")));
  EXPECT_THAT(problems_of(R"({"measurements": {"e": {"kind": "cutting_edge", "flank_um": [0, 80]}}})"),
              ElementsAre(problem("/measurements/e/flank_um", "above 0")));
}

TEST(APlan, IsRefusedWhereNamesLeadNowhere) {
  EXPECT_THAT(problems_of(R"({
    "surfaces": {"a": {"from": "mesured", "steps": [{"op": "level", "regions": ["lnd"]}]}},
    "regions": {"land": {"circle_um": {"x": 1, "y": 1, "radius": 1}}, "none": {"union": ["lands"]}},
    "measurements": {"x": {"kind": "areal", "surface": "b", "region": "lend", "parameters": ["Sa"]},
                     "y": {"kind": "step_between", "lower": "land", "upper": "up"}}})"),
              UnorderedElementsAre(problem("/surfaces/a/from", "\"mesured\" is no surface"),
                                   problem("/surfaces/a/steps/0/regions", "did you mean"),
                                   problem("/regions/none/union", "\"lands\" is no region"),
                                   problem("/measurements/x/surface", "\"b\" is no surface"),
                                   problem("/measurements/x/region", "\"lend\" is no region"),
                                   problem("/measurements/y/upper", "\"up\" is no region")));
}

TEST(APlan, IsRefusedWhereASurfaceOrARegionIsMadeOfItself) {
  EXPECT_THAT(
      problems_of(R"({"surfaces": {"a": {"from": "b"}, "b": {"from": "a"}},
                              "regions": {"p": {"not": "q"}, "q": {"not": "p"}}})"),
      UnorderedElementsAre(problem("/surfaces/a/from", "made of itself"), problem("/surfaces/b/from", "made of itself"),
                           problem("/regions/p/not", "made of itself"), problem("/regions/q/not", "made of itself")));
}

TEST(APlan, IsRefusedWhereFiltersLeaveNothing) {
  EXPECT_THAT(problems_of(R"({"surfaces": {"a": {"steps": [
                {"op": "filter", "side": "S", "nesting_um": 80},
                {"op": "filter", "side": "L", "nesting_um": 80}]}}})"),
              ElementsAre(problem("/surfaces/a/steps/1/nesting_um", "leave nothing")));
}

TEST(APlan, IsRefusedWhereFiltersOfSurfacesOnOneWayLeaveNothing) {
  EXPECT_THAT(problems_of(R"({"surfaces": {
    "first": {"steps": [{"op": "filter", "side": "L", "nesting_um": 80}]},
    "between": {"from": "first", "steps": [{"op": "invert"}]},
    "last": {"from": "between", "steps": [{"op": "invert"}, {"op": "filter", "side": "S", "nesting_um": 100}]},
    "beside": {"steps": [{"op": "filter", "side": "S", "nesting_um": 100}]}}})"),
              ElementsAre(problem("/surfaces/last/steps/1/nesting_um", "expected S below L")));
}

TEST(APlan, IsRefusedForAllOfItsMistakesAtOnce) {
  EXPECT_THAT(
      problems_of(R"({
    "surfaces": {"a": {"from": "b"}, "b": {"from": "a"},
                 "c": {"steps": [{"op": "filter", "side": "S", "nesting_um": 90},
                                 {"op": "filter", "side": "L", "nesting_um": 80}]}},
    "regions": {"none": {"threshold_um": {}},
                "left": {"rectangle_um": {"x": -5, "y": 0, "width": 5, "height": 5}},
                "file": {"mask_png": "../x.png"}},
    "measurements": {
      "one": {"kind": "areal", "surface": "no", "region": "nowhere", "parameters": ["Sa"],
              "limits": {"Sa_um": {"lower": 2, "upper": 1}, "height_um": {"upper": 1}}},
      "two": {"kind": "step_height", "band_from_to_um": [9, 3]}}})"),
      UnorderedElementsAre(
          problem("/surfaces/a/from", "made of itself"), problem("/surfaces/b/from", "made of itself"),
          problem("/surfaces/c/steps/1/nesting_um", "expected S below L"),
          problem("/regions/none/threshold_um", "is empty"), problem("/regions/left/rectangle_um", "left of or above"),
          problem("/regions/file/mask_png", "without a path"), problem("/measurements/one/surface", "no surface"),
          problem("/measurements/one/region", "no region"),
          problem("/measurements/one/limits/Sa_um", "lower is above upper"),
          problem("/measurements/one/limits/height_um", "no value of this measurement"),
          problem("/measurements/two/band_from_to_um", "the first the smaller")));
}

TEST(APlan, IsRefusedForLimitsThatNothingHasOrThatCross) {
  EXPECT_THAT(problems_of(R"({"measurements": {
                "s": {"kind": "step_height", "limits": {"depth_um": {"lower": 1}, "height_um": {"lower": 2, "upper": 1}}},
                "t": {"kind": "areal", "parameters": ["Sq"], "limits": {"Sa_um": {"lower": 1}, "Sq_um": {}}}}})"),
              UnorderedElementsAre(problem("/measurements/s/limits/depth_um", "it has height_um"),
                                   problem("/measurements/s/limits/height_um", "lower is above upper"),
                                   problem("/measurements/t/limits/Sa_um", "it has Sq_um"),
                                   problem("/measurements/t/limits/Sq_um", "is empty")));
}

TEST(APlan, IsRefusedForAMemberThatItsKindHasNot) {
  EXPECT_THAT(problems_of(R"({"measurements": {"s": {"kind": "areal", "parameters": ["Sa"], "traces": 9}}})"),
              ElementsAre(problem("/measurements/s/traces", "unknown key")));
  EXPECT_THAT(problems_of(R"({"measurements": {"s": {"kind": "areal", "parameters": ["Sx"]}}})"),
              ElementsAre(problem("/measurements/s/parameters", "\"Sx\" is not accepted")));
}

TEST(APlan, IsRefusedWhereAPlcCouldNotTellMeasurementsApart) {
  EXPECT_THAT(problems_of(R"({"measurements": {
                "step_left": {"kind": "step_height"}, "step_right": {"kind": "step_height"}}})"),
              ElementsAre(problem("/measurements/step_right/id", "is the id of step_left too")));
  EXPECT_THAT(problems_of(R"({"measurements": {
                "step_left": {"kind": "step_height"}, "step_right": {"kind": "step_height", "id": "sr"}}})"),
              IsEmpty());
}

TEST(APlan, IsRefusedForPairsThatDoNotRiseAndShapesThatEncloseNothing) {
  EXPECT_THAT(problems_of(R"({
    "regions": {"line": {"polygon_um": [[0, 0], [1, 1], [2, 2]]}, "none": {"threshold_um": {}},
                "crossed": {"threshold_um": {"above": 2, "below": 1}}},
    "measurements": {"a": {"kind": "step_height", "band_from_to_um": [5, 5]},
                     "b": {"kind": "cutting_edge", "flank_um": [80, 15]},
                     "c": {"kind": "profile", "from_um": [1, 1], "to_um": [1, 1], "parameters": ["Ra"]}}})"),
              UnorderedElementsAre(problem("/regions/line/polygon_um", ""),
                                   problem("/regions/none/threshold_um", "expected above, below"),
                                   problem("/regions/crossed/threshold_um", "above is not less than below"),
                                   problem("/measurements/a/band_from_to_um", "the first the smaller"),
                                   problem("/measurements/b/flank_um", "the first the smaller"),
                                   problem("/measurements/c/to_um", "where the profile begins")));
}

}  // namespace
}  // namespace fvd
