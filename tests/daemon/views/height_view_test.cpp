#include "daemon/views/height_view.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/daemon/views/made_maps.hpp"

namespace fvd {
namespace {

using test::letter_f;
using test::read_view;
using test::ReadView;
using test::rows_of;

ViewWindow all_of(const Plane<float>& plane) { return {0, 0, plane.width(), plane.height()}; }

ReadView viewed(Plane<float> plane, int most, BlockValue value = BlockValue::kMean) {
  const ViewWindow window = all_of(plane);
  return read_view(HeightView(rows_of(std::move(plane)), window, most, value).whole());
}

/// Every block against the points that it stands for.
void expect_blocks(const Plane<float>& plane, const ViewWindow& window, int most) {
  const HeightView made(rows_of(plane.clone()), window, most, BlockValue::kMean);
  const ReadView view = read_view(made.whole());
  const int factor = made.factor();
  ASSERT_LE(std::max(made.width(), made.height()), most);
  ASSERT_EQ(view.planes, factor == 1 ? 1U : 3U);
  for (int row = 0; row < made.height(); ++row) {
    for (int column = 0; column < made.width(); ++column) {
      double sum = 0.0;
      int count = 0;
      float lowest = std::numeric_limits<float>::infinity();
      float highest = -lowest;
      for (int y = row * factor; y < std::min(window.height, (row + 1) * factor); ++y) {
        for (int x = column * factor; x < std::min(window.width, (column + 1) * factor); ++x) {
          const float value = plane.at(window.x + x, window.y + y);
          if (std::isnan(value)) continue;
          sum += static_cast<double>(value);
          ++count;
          lowest = std::min(lowest, value);
          highest = std::max(highest, value);
        }
      }
      const float mean = view.at(0, column, row);
      SCOPED_TRACE("block " + std::to_string(column) + ", " + std::to_string(row));
      if (count == 0) {
        for (std::size_t i = 0; i < view.planes; ++i) EXPECT_TRUE(std::isnan(view.at(i, column, row)));
        continue;
      }
      EXPECT_FLOAT_EQ(mean, static_cast<float>(sum / count));
      if (factor == 1) continue;
      EXPECT_EQ(view.at(1, column, row), lowest);
      EXPECT_EQ(view.at(2, column, row), highest);
      EXPECT_GE(mean, lowest);
      EXPECT_LE(mean, highest);
    }
  }
}

TEST(HeightView, GivesThePointsThemselvesWhereTheyFit) {
  const Plane<float> plane = test::rough(16, 16, 0.2);

  const ReadView view = viewed(plane.clone(), 512);

  EXPECT_EQ(view.version, 1U);
  EXPECT_EQ(view.width, 16U);
  EXPECT_EQ(view.height, 16U);
  EXPECT_EQ(view.factor, 1U);
  EXPECT_EQ(view.planes, 1U);
  EXPECT_EQ(view.map_width, 16U);
  EXPECT_EQ(view.map_height, 16U);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const float point = plane.at(x, y);
      EXPECT_TRUE(std::isnan(point) ? std::isnan(view.at(0, x, y)) : point == view.at(0, x, y)) << x << ", " << y;
    }
  }
}

TEST(HeightView, TellsOfEveryBlockWhatItsPointsAre) {
  const Plane<float> plane = test::rough(97, 61, 0.3);
  for (const int most : {1, 2, 7, 13, 48, 49, 96, 97, 500}) {
    SCOPED_TRACE("at most " + std::to_string(most));
    expect_blocks(plane, all_of(plane), most);
    expect_blocks(plane, {5, 11, 64, 32}, most);
    expect_blocks(plane, {96, 60, 1, 1}, most);
    expect_blocks(plane, {0, 30, 97, 1}, most);
    expect_blocks(plane, {13, 0, 1, 61}, most);
  }
}

TEST(HeightView, LosesNoSpike) {
  Plane<float> plane(300, 200, 0.0F);
  plane.at(123, 45) = 7e-6F;
  plane.at(250, 199) = -3e-6F;

  const ReadView view = viewed(std::move(plane), 10);

  EXPECT_EQ(view.factor, 30U);
  EXPECT_EQ(view.at(2, 123 / 30, 45 / 30), 7e-6F);
  EXPECT_EQ(view.at(1, 250 / 30, 199 / 30), -3e-6F);
}

TEST(HeightView, ShowsTheLetterFUpright) {
  for (const int most : {64, 32, 16}) {
    SCOPED_TRACE("at most " + std::to_string(most));
    const ReadView view = viewed(letter_f(64, 64), most);
    const auto is_ink = [&](double x, double y) {
      return view.at(0, static_cast<int>(x * view.width), static_cast<int>(y * view.height)) > 5e-6F;
    };
    EXPECT_TRUE(is_ink(0.20, 0.80)) << "the stem's foot, at the left";
    EXPECT_FALSE(is_ink(0.80, 0.80)) << "nothing at the right of it";
    EXPECT_TRUE(is_ink(0.80, 0.20)) << "the upper bar's end, at the right";
    EXPECT_TRUE(is_ink(0.50, 0.50)) << "the middle bar";
    EXPECT_FALSE(is_ink(0.80, 0.50)) << "which is shorter";
  }
}

TEST(HeightView, OfAMapWithoutAValidPointHasHolesAlone) {
  const ReadView view = viewed(Plane<float>(50, 40, test::kNoPoint), 10);

  EXPECT_EQ(view.values.size(), 3U * 10U * 8U);
  for (const float value : view.values) EXPECT_TRUE(std::isnan(value));
}

TEST(HeightView, IsTheSameInPieces) {
  const Plane<float> plane = test::rough(130, 70, 0.1);
  for (const int most : {200, 40}) {
    const HeightView view(rows_of(plane.clone()), {3, 4, 121, 60}, most, BlockValue::kMean);
    std::string pieces = view.header();
    for (int plane_index = 0; plane_index < view.planes(); ++plane_index) {
      for (int y = 0; y < view.height(); y += 7) {
        pieces += view.rows(plane_index, y, std::min(view.height(), y + 7));
      }
    }
    EXPECT_TRUE(pieces == view.whole());
    EXPECT_EQ(pieces.size(), view.bytes());
  }
}

TEST(HeightView, OfCodesTellsTheCommonestOfABlock) {
  Plane<float> codes(4, 4, 0.0F);
  for (const int x : {0, 1}) codes.at(x, 0) = 16.0F;  // half of the block: the hole is shown
  codes.at(2, 0) = 3.0F;                              // a quarter: it is not
  codes.at(0, 2) = codes.at(1, 2) = codes.at(0, 3) = 1.0F;
  codes.at(1, 3) = 4096.0F;
  codes.at(2, 2) = codes.at(3, 2) = codes.at(2, 3) = codes.at(3, 3) = test::kNoPoint;

  const ReadView view = viewed(std::move(codes), 2, BlockValue::kCommonest);

  EXPECT_EQ(view.at(0, 0, 0), 16.0F);
  EXPECT_EQ(view.at(0, 1, 0), 0.0F);
  EXPECT_EQ(view.at(2, 1, 0), 3.0F) << "and is seen in the highest";
  EXPECT_EQ(view.at(0, 0, 1), 1.0F) << "no mean of 1 and 4096";
  EXPECT_EQ(view.at(2, 0, 1), 4096.0F);
  EXPECT_TRUE(std::isnan(view.at(0, 1, 1)));
}

TEST(HeightView, CountsTheFirstSixteenCodesOfABlock) {
  Plane<float> codes(40, 1);
  for (int x = 0; x < 40; ++x) codes.at(x, 0) = static_cast<float>(x < 20 ? x : 5);

  const ReadView view = viewed(std::move(codes), 1, BlockValue::kCommonest);

  EXPECT_EQ(view.at(0, 0, 0), 5.0F);
  EXPECT_EQ(view.at(2, 0, 0), 19.0F);
}

}  // namespace
}  // namespace fvd
