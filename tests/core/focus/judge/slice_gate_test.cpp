#include "core/focus/judge/slice_gate.hpp"

#include <array>
#include <ostream>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/focus/judge/slice_first_look.hpp"
#include "tests/core/focus/judge/judged_scene.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::change;
using test::dark_level;
using test::Image;
using test::judge_scene;
using test::Judged;
using test::Scene;
using test::SceneSettings;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Kind {
  const char* name;
  SceneSettings settings;
};
std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

std::vector<Kind> clean_scenes() {
  std::vector<Kind> kinds;
  kinds.push_back({"tilted", {}});
  SceneSettings settings;
  settings.contrast = 6.0;
  kinds.push_back({"weak", settings});
  settings = {};
  settings.contrast = 0.0;
  kinds.push_back({"textureless", settings});
  settings = {};
  settings.step_um = 50.0;
  settings.slices = 9;
  kinds.push_back({"coarse", settings});
  settings = {};
  settings.step_um = 2.0;
  settings.slices = 60;
  settings.base_um = 60.0;
  settings.tilt_x_um_per_px = 0.1;
  kinds.push_back({"fine", settings});
  settings = {};
  settings.tilt_x_um_per_px = 0.0;
  kinds.push_back({"flat", settings});
  settings.base_um = 105.0;
  settings.step_um = 30.0;
  kinds.push_back({"flat_between_slices", settings});
  settings = {};
  settings.base_um = 900.0;
  kinds.push_back({"out_of_focus", settings});
  return kinds;
}

class AScene : public testing::TestWithParam<Kind> {};

TEST_P(AScene, ThatIsCleanHasNoSuspects) {
  SceneSettings settings = GetParam().settings;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    settings.seed = seed;
    const Scene scene(settings);
    const Judged judged = judge_scene(scene);
    for (const SuspectSlice& slice : judged.suspects) ADD_FAILURE() << suspect_text(slice) << ", seed " << seed;
    EXPECT_EQ(judged.passed.size(), scene.slices.size());
    EXPECT_LT(judged.flicker_percent, 0.3);
    for (const double gain : judged.gains) EXPECT_NEAR(gain, 1.0, 0.01);
    SliceFirstLook look;
    for (std::size_t k = 0; k < scene.slices.size(); ++k) {
      EXPECT_EQ(look.doubt(scene.view(k), static_cast<int>(k), 0.0), std::nullopt) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clean, AScene, testing::ValuesIn(clean_scenes()),
                         [](const auto& test) { return std::string(test.param.name); });

/// What is planted in a clean scene, and how it must be called.
struct Fault {
  const char* name;
  SuspectReason reason;
  void (*plant)(Scene& scene, std::size_t at);
  bool at_once;        ///< known without the slices that follow
  int lost = 1;        ///< slices that are left out
  int after_last = 0;  ///< slices that must follow
};
std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

constexpr std::array kFaults{
    Fault{"dark", SuspectReason::kDark,
          [](Scene& scene, std::size_t at) {
            change(scene.slices[at], [](double, int x, int y) { return test::dark_level(x, y); });
          },
          true},
    Fault{"black", SuspectReason::kConstant,
          [](Scene& scene, std::size_t at) { change(scene.slices[at], [](double, int, int) { return 0.0; }); }, true},
    Fault{"constant", SuspectReason::kConstant,
          [](Scene& scene, std::size_t at) { change(scene.slices[at], [](double, int, int) { return 128.0; }); }, true},
    Fault{"half", SuspectReason::kPartial,
          [](Scene& scene, std::size_t at) {
            change(scene.slices[at], [](double level, int, int y) { return y < 120 ? level : 0.0; });
          },
          true},
    Fault{"half_left_over", SuspectReason::kPartial,
          [](Scene& scene, std::size_t at) {
            if (at == 0) return;
            const auto& before = scene.slices[at - 1];
            change(scene.slices[at], [&](double level, int x, int y) { return y < 80 ? level : before.at(x, y); });
          },
          true},
    Fault{"flash", SuspectReason::kBrighter,
          [](Scene& scene, std::size_t at) {
            for (std::size_t k = 0; k < scene.slices.size(); ++k) {
              if (k != at) change(scene.slices[k], [](double level, int, int) { return 0.3 * level; });
            }
          },
          false},
    Fault{"repeated", SuspectReason::kRepeated,
          [](Scene& scene, std::size_t at) { scene.slices[at] = scene.slices[at - 1].clone(); }, true},
    Fault{"exchanged", SuspectReason::kExchanged,
          [](Scene& scene, std::size_t at) { std::swap(scene.slices[at], scene.slices[at + 1]); }, false, 2},
    Fault{"stood_still", SuspectReason::kStandstill,
          [](Scene& scene, std::size_t at) { scene.slices[at] = scene.again(at - 1); }, false},
    Fault{"shaken", SuspectReason::kVibration,
          [](Scene& scene, std::size_t at) { test::shake(scene.slices[at], 3, 2); }, false},
};

class AFault : public testing::TestWithParam<Fault> {};

TEST_P(AFault, IsFoundAndNothingElseIs) {
  const Fault& fault = GetParam();
  const bool needs_neighbours = fault.reason == SuspectReason::kExchanged ||
                                fault.reason == SuspectReason::kStandstill || fault.reason == SuspectReason::kVibration;
  int found = 0;
  for (const std::size_t at : {std::size_t{0}, std::size_t{6}, std::size_t{10}, std::size_t{13}, std::size_t{20}}) {
    if ((needs_neighbours || fault.reason == SuspectReason::kRepeated || std::string(fault.name) == "half_left_over") &&
        (at == 0 || at == 20)) {
      continue;
    }
    SCOPED_TRACE(at);
    Scene scene({});
    fault.plant(scene, at);
    const Judged judged = judge_scene(scene);
    for (const SuspectSlice& slice : judged.suspects) EXPECT_EQ(slice.reason, fault.reason) << suspect_text(slice);
    std::vector<int> expected;
    for (int i = 0; i < fault.lost; ++i) expected.push_back(static_cast<int>(at) + i);
    EXPECT_EQ(judged.suspect_indices(), expected);
    found += judged.suspect_indices() == expected ? 1 : 0;
    if (!fault.at_once || at == 0) continue;
    SliceFirstLook look;
    std::vector<int> doubted;
    for (std::size_t k = 0; k < scene.slices.size(); ++k) {
      if (look.doubt(scene.view(k), static_cast<int>(k), 0.0)) doubted.push_back(static_cast<int>(k));
    }
    EXPECT_THAT(doubted, ElementsAre(static_cast<int>(at)));
  }
  EXPECT_GE(found, 3);
}

INSTANTIATE_TEST_SUITE_P(Planted, AFault, testing::ValuesIn(kFaults),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(SliceGate, FindsTwoExposuresThatLoseLessThanHalfOfTheSharpness) {
  for (const std::size_t at : {std::size_t{8}, std::size_t{10}, std::size_t{13}}) {
    SCOPED_TRACE(at);
    Scene scene({.noise = 1.0});
    test::shake(scene.slices[at], 8, 5);
    const std::vector<double> noise(static_cast<std::size_t>(slice_figures(scene.view(at)).tiles()), 9.0);
    const MotionFigure motion = motion_of(slice_figures(scene.view(at - 1)), slice_figures(scene.view(at)),
                                          slice_figures(scene.view(at + 1)), noise);
    EXPECT_FALSE(motion.turned());
    EXPECT_GT(motion.sharpness, -0.7);
    EXPECT_EQ(judge_scene(scene).suspect_indices(), std::vector<int>{static_cast<int>(at)});
  }
}

/// Stripes of 16 px at two heights, so that every tile has both: between them a slice is less sharp than its
/// neighbours.
TEST(SliceGate, BelievesTheSlicesBetweenTwoLevels) {
  for (const double apart_um : {20.0, 30.0, 40.0}) {
    SceneSettings level;
    level.tilt_x_um_per_px = 0.0;
    Scene scene(level);
    level.base_um += apart_um;
    const Scene other(level);
    for (std::size_t k = 0; k < scene.slices.size(); ++k) {
      change(scene.slices[k], [&](double grey, int x, int y) {
        return x / 16 % 2 == 0 ? grey : static_cast<double>(other.slices[k].at(x, y));
      });
    }
    EXPECT_THAT(judge_scene(scene).suspect_indices(), IsEmpty()) << apart_um;
  }
}

/// Every slice a fraction of a pixel aside, as a stage that trembles leaves it: in a fine scan more than what defocus
/// changes.
TEST(SliceGate, BelievesSlicesThatJitter) {
  for (const double rms_px : {0.1, 0.2, 0.4}) {
    Scene scene({.step_um = 4.0, .slices = 40});
    std::mt19937 random(7);
    std::normal_distribution<double> aside(0.0, rms_px);
    for (Image& slice : scene.slices) {
      const Image still = slice.clone();
      const double by = std::clamp(aside(random), -1.0, 1.0);
      change(slice, [&](double grey, int x, int y) {
        const int u = std::clamp(x + (by > 0.0 ? 1 : -1), 0, still.width() - 1);
        return grey + std::abs(by) * (static_cast<double>(still.at(u, y)) - grey);
      });
    }
    EXPECT_THAT(judge_scene(scene).suspect_indices(), IsEmpty()) << rms_px;
  }
}

/// Two levels so far apart that hardly anything changes between them.
TEST(SliceGate, BelievesSlicesBetweenTheFociOfTwoLevels) {
  for (const double apart_um : {60.0, 90.0, 120.0}) {
    for (const double step_um : {15.0, 25.0, 35.0}) {
      const SceneSettings level{.step_um = step_um, .slices = 12, .tilt_x_um_per_px = 0.0};
      Scene scene(level);
      SceneSettings higher = level;
      higher.base_um += apart_um;
      const Scene other(higher);
      for (std::size_t k = 0; k < scene.slices.size(); ++k) {
        change(scene.slices[k], [&](double grey, int x, int y) {
          return x / 16 % 2 == 0 ? grey : static_cast<double>(other.slices[k].at(x, y));
        });
      }
      EXPECT_THAT(judge_scene(scene).suspect_indices(), IsEmpty()) << apart_um << ' ' << step_um;
    }
  }
}

TEST(SliceGate, BelievesSlicesWithABarThatNeverChanges) {
  Scene scene({});
  for (Image& slice : scene.slices) {
    change(slice, [&](double grey, int x, int y) { return y < 200 ? grey : (x / 7 + y / 9) % 5 == 0 ? 255.0 : 0.0; });
  }
  EXPECT_THAT(judge_scene(scene).suspect_indices(), IsEmpty());
}

TEST(SliceGate, LeavesOutNothingBesideABadSlice) {
  for (const std::size_t bad : {std::size_t{8}, std::size_t{9}, std::size_t{10}, std::size_t{11}}) {
    Scene scene({.tilt_x_um_per_px = 0.0});
    change(scene.slices[bad], [](double, int, int) { return 0.0; });
    EXPECT_THAT(judge_scene(scene).suspect_indices(), ElementsAre(static_cast<int>(bad)));
  }
}

TEST(SliceFirstLook, BelievesADarkFirstSliceThatCannotComeAgain) {
  Scene scene({.slices = 1});
  change(scene.slices[0], [](double, int x, int y) { return dark_level(x, y); });
  SliceFirstLook look;
  EXPECT_FALSE(look.doubt(scene.view(0), 0, 0.0, false));
}

TEST(SliceGate, LeavesOutTheDarkSlicesOfALampThatComesUp) {
  const auto left_out = [](std::array<double, 3> light) {
    Scene scene({});
    for (std::size_t k = 0; k < light.size(); ++k) {
      change(scene.slices[k], [&](double level, int, int) { return light[k] * level; });
    }
    return judge_scene(scene).suspect_indices();
  };
  EXPECT_THAT(left_out({0.1, 0.3, 0.7}), ElementsAre(0, 1));
  EXPECT_THAT(left_out({0.1, 0.4, 0.7}), ElementsAre(0));
  EXPECT_THAT(left_out({0.6, 0.7, 0.9}), IsEmpty());
}

TEST(SliceGate, TellsTheGainOfFlickeringLight) {
  for (const double size : {0.01, 0.02, 0.05, 0.1, 0.2}) {
    Scene scene({});
    std::mt19937 random(21);
    std::normal_distribution<double> normal(1.0, size);
    std::vector<double> light;
    for (auto& slice : scene.slices) {
      light.push_back(std::clamp(normal(random), 0.5, 1.6));
      change(slice, [&](double level, int, int) { return 0.7 * light.back() * level; });
    }
    const Judged judged = judge_scene(scene);
    EXPECT_THAT(judged.suspects, IsEmpty()) << size;
    ASSERT_EQ(judged.passed.size(), light.size());
    for (std::size_t k = 0; k < light.size(); ++k) EXPECT_NEAR(judged.gains[k] * light[k] / light[0], 1.0, 0.006);
    EXPECT_NEAR(judged.flicker_percent, 100.0 * size, 35.0 * size);
  }
}

TEST(SliceGate, TakesLightThatIsSpreadFromClippedPixelsForNoFlicker) {
  Scene scene({});
  for (std::size_t k = 0; k < scene.slices.size(); ++k) {
    // A glint in each of the places, clipped in focus; its halo grows by a pixel a slice on either side of slice 10.
    const int reach = 2 + std::abs(static_cast<int>(k) - 10);
    change(scene.slices[k], [&](double level, int x, int y) {
      const int away = std::max(std::abs(x % 24 - 12), std::abs(y % 24 - 12));
      return away <= 1 ? 400.0 : away <= reach ? level + 40.0 : level;
    });
  }
  const Judged judged = judge_scene(scene);
  EXPECT_THAT(judged.suspects, IsEmpty());
  for (const double gain : judged.gains) EXPECT_EQ(gain, 1.0);
}

TEST(SliceGate, RefusesOneSuspectMoreThanIsAllowedAndNamesIt) {
  Scene scene({});
  for (const std::size_t at : {std::size_t{5}, std::size_t{9}}) {
    change(scene.slices[at], [](double, int, int) { return 77.0; });
  }
  EXPECT_EQ(judge_scene(scene, 2).suspects.size(), 2U);
  test::expect_error(ErrorCode::kBadSlice, {"slice 9 at 90 um", "same grey level", "allowed_lost_slices"},
                     [&] { (void)judge_scene(scene, 1); });
}

TEST(SliceGate, TellsFiguresOfASuspectAsPeopleWriteThem) {
  const auto text = [](SuspectReason reason, double figure) {
    SuspectSlice slice;
    slice.reason = reason;
    slice.figure = figure;
    return suspect_text(slice);
  };
  EXPECT_THAT(text(SuspectReason::kConstant, 1.0), HasSubstr("the level is 100 % of full scale"));
  EXPECT_THAT(text(SuspectReason::kBrighter, 250.0), HasSubstr("is 250 times its neighbours'"));
  EXPECT_THAT(text(SuspectReason::kBrighter, 2.64), HasSubstr("is 2.6 times its neighbours'"));
  EXPECT_THAT(text(SuspectReason::kStandstill, -0.012), HasSubstr("changed by 1.2 % of"));
  EXPECT_THAT(text(SuspectReason::kStandstill, 1e-7), HasSubstr("changed by 0 % of"));
}

TEST(SliceGate, HoldsNoMoreThanItSays) {
  const Scene scene({});
  SliceGate<int> gate(0);
  int passed = 0;
  for (int k = 0; k < 21; ++k) {
    const auto at = static_cast<std::size_t>(k);
    gate.push(int{k}, scene.view(at), slice_figures(scene.view(at)), k, 10.0 * k,
              [&passed](int&&, double, double) { ++passed; });
    EXPECT_LE(k + 1 - passed, SliceGate<int>::kHeldBack);
  }
}

TEST(SliceFirstLook, DoubtsADarkFirstSliceOnce) {
  Scene dim({});
  for (auto& slice : dim.slices) change(slice, [](double level, int, int) { return 0.1 * level; });
  SliceFirstLook look;
  const auto first = look.doubt(dim.view(0), 0, 0.0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->reason, SuspectReason::kDark);
  EXPECT_FALSE(look.doubt(dim.view(1), 0, 0.0));
  EXPECT_TRUE(look.withdrew());
  const Scene lit({});
  SliceFirstLook other;
  Scene dark({});
  change(dark.slices[0], [](double, int x, int y) { return test::dark_level(x, y); });
  EXPECT_TRUE(other.doubt(dark.view(0), 0, 0.0));
  EXPECT_FALSE(other.doubt(lit.view(0), 0, 0.0));
  EXPECT_FALSE(other.withdrew());
}

}  // namespace
}  // namespace fvd
