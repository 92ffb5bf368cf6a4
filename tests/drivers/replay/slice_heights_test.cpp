#include "drivers/replay/slice_heights.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::expect_error;
using test::ScratchDir;
using testing::ElementsAre;

SliceList list_of(std::size_t slices) {
  SliceList list;
  list.slices.resize(slices);
  list.description = "s*.png";
  return list;
}

TEST(SliceHeights, RiseOrFallWithTheStep) {
  EXPECT_THAT(slice_heights_um(ZSpacing{-7, 10}, list_of(3)), ElementsAre(-7.0, 3.0, 13.0));
  EXPECT_THAT(slice_heights_um(ZSpacing{0, -2.5}, list_of(3)), ElementsAre(0.0, -2.5, -5.0));
}

TEST(SliceHeights, NeedAStepThatIsANumber) {
  for (const double step : {0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    expect_error(ErrorCode::kBadInput, {"step"}, [&] { (void)slice_heights_um(ZSpacing{0, step}, list_of(3)); });
  }
}

TEST(SliceHeights, DoNotComeFromAStepAcrossAGap) {
  SliceList list = list_of(3);
  list.gap = "s1.png is followed by s3.png";
  expect_error(ErrorCode::kBadInput, {"s1.png is followed by s3.png", "give a file"}, [&] {
    (void)slice_heights_um(ZSpacing{0, 1}, list);
  });
}

TEST(SliceHeights, ComeFromAFileInItsUnit) {
  const ScratchDir scratch;
  test::write_text(scratch / "z.txt", "\xEF\xBB\xBF# z of the slices\r\n\r\n 0.001 # first\r\n0.003\n\t1e-2\n");
  EXPECT_THAT(slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMillimetre}, list_of(3)),
              ElementsAre(1.0, 3.0, 10.0));
  EXPECT_THAT(slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMetre}, list_of(3)),
              ElementsAre(1000.0, 3000.0, 10000.0));
  SliceList gap = list_of(3);
  gap.gap = "a gap";
  EXPECT_THAT(slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMicrometre}, gap),
              ElementsAre(0.001, 0.003, 0.01));
}

TEST(SliceHeights, AreNotTakenFromNumbersOfAnotherUnit) {
  const ScratchDir scratch;
  test::write_text(scratch / "z.txt", "0\n1e-5\n2e-5\n");
  expect_error(ErrorCode::kBadInput, {"z.txt", "the mean step is 1e-05 um", "--z-unit", "stage.replay_z_unit"}, [&] {
    (void)slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMicrometre}, list_of(3));
  });
  EXPECT_THAT(slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMetre}, list_of(3)),
              ElementsAre(0.0, testing::DoubleEq(10.0), testing::DoubleEq(20.0)));
}

TEST(SliceHeights, NameTheFileAndTheLineThatIsWrong) {
  const ScratchDir scratch;
  const auto expect_refused = [&](const std::string& text, std::initializer_list<std::string> words) {
    test::write_text(scratch / "z.txt", text);
    expect_error(ErrorCode::kBadInput, words, [&] {
      (void)slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMicrometre}, list_of(3));
    });
  };
  expect_refused("1\n2\n", {"z.txt", "2 heights", "3 slices"});
  expect_refused("1\n2\n3\n4\n", {"z.txt", "4 heights"});
  expect_refused("1\n2,5\n3\n", {"z.txt line 2", "2,5"});
  expect_refused("1\nabc\n3\n", {"z.txt line 2", "abc"});
  expect_refused("1 2\n3\n4\n", {"z.txt line 1", "1 2"});
  expect_refused("1\n2\nnan\n", {"z.txt line 3", "finite"});
  expect_refused("1\n2\n1e999\n", {"z.txt line 3"});
  expect_refused("1\n2\n2\n", {"rise or fall", "slice 2"});
  expect_refused("1\n3\n2\n", {"rise or fall", "slice 2"});
  expect_refused("3\n1\n2\n", {"rise or fall", "slice 2"});
  expect_refused("", {"0 heights"});
}

TEST(SliceHeights, NameTheFileThatIsMissing) {
  expect_error(ErrorCode::kBadInput, {"nowhere.txt"}, [] {
    (void)slice_heights_um(ZFile{"/nowhere.txt", LengthUnit::kMetre}, list_of(3));
  });
}

TEST(SliceHeights, KnowTheUnitsByName) {
  EXPECT_EQ(length_unit_from_name("um"), LengthUnit::kMicrometre);
  EXPECT_EQ(length_unit_from_name("mm"), LengthUnit::kMillimetre);
  EXPECT_EQ(length_unit_from_name("m"), LengthUnit::kMetre);
  EXPECT_FALSE(length_unit_from_name("inch"));
}

TEST(NearestSlice, IsFoundOnBothSidesAndBeyondTheEnds) {
  const std::vector<double> z_um{0, 10, 25};
  EXPECT_EQ(nearest_slice(z_um, -100), 0);
  EXPECT_EQ(nearest_slice(z_um, 4.9), 0);
  EXPECT_EQ(nearest_slice(z_um, 5.1), 1);
  EXPECT_EQ(nearest_slice(z_um, 18), 2);
  EXPECT_EQ(nearest_slice(z_um, 1e9), 2);
}

}  // namespace
}  // namespace fvd
