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
  expect_refused("1\n2.5\n3,5\n", {"z.txt line 3", "3,5", "line 2 a point"});
  expect_refused("0\n1,000\n2,000\n", {"z.txt line 2", "1,000", "thousands"});
  expect_refused("1\n+-2\n3\n", {"z.txt line 2", "+-2"});
  expect_refused("z\nheight\n3\n", {"z.txt line 2", "height"});
  expect_refused("z (mm)\n1\n2\n3\n", {"z.txt line 1", "says mm", "read as um", "--z-unit mm"});
  expect_refused("nan\n2\n3\n", {"z.txt line 1", "finite"});
  expect_refused("1\nabc\n3\n", {"z.txt line 2", "abc"});
  expect_refused("1 2\n3\n4\n", {"z.txt line 1", "1 2"});
  expect_refused("1\n2\nnan\n", {"z.txt line 3", "finite"});
  expect_refused("1\n2\n1e999\n", {"z.txt line 3"});
  expect_refused("1\n2\n2\n", {"rise or fall", "slice 2"});
  expect_refused("1\n3\n2\n", {"rise or fall", "slice 2"});
  expect_refused("3\n1\n2\n", {"rise or fall", "slice 2", "in the order of the slices"});
  expect_refused("", {"0 heights"});
}

std::string utf16(const std::string& text, bool big_endian) {
  std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) bytes += big_endian ? std::string({'\0', c}) : std::string({c, '\0'});
  return bytes;
}

TEST(SliceHeights, ComeFromListsOfSpreadsheetsAndShells) {
  const ScratchDir scratch;
  const ZFile file{scratch / "z.txt", LengthUnit::kMicrometre};
  for (const std::string& text :
       {utf16("0\r\n10\r\n20\r\n", false), utf16("z\r\n0\r\n10\r\n20", true), std::string("0\n+10.0\n+20\n"),
        std::string("z_um\n0\n10\n20\n"), std::string("\"z / \xC2\xB5m\"\r0\r10\r20\r"), std::string("0\n10,0\n20,0\n"),
        std::string("Position\n-0,000\n10,000\n20,000\n")}) {
    test::write_text(file.path, text);
    EXPECT_THAT(slice_heights_um(file, list_of(3)), ElementsAre(0.0, 10.0, 20.0)) << text;
  }
}

TEST(SliceHeights, AreNotTakenFromBytesThatAreNoText) {
  const ScratchDir scratch;
  const ZFile file{scratch / "z.txt", LengthUnit::kMicrometre};
  test::write_text(file.path, utf16("0\n1\n2\n", false).substr(2));
  expect_error(ErrorCode::kBadInput, {"z.txt holds NUL bytes", "UTF-8"},
               [&] { (void)slice_heights_um(file, list_of(3)); });
  test::write_text(file.path, utf16("0\n1\n2\n", false) + "3");
  expect_error(ErrorCode::kBadInput, {"z.txt is UTF-16", "cut off"}, [&] { (void)slice_heights_um(file, list_of(3)); });
  test::write_text(file.path, "1\n\x80\x81\n3\n");
  expect_error(ErrorCode::kBadInput, {"z.txt line 2: '\\x80\\x81' is not one number"},
               [&] { (void)slice_heights_um(file, list_of(3)); });
}

TEST(SliceHeights, ComeFromTheNamesWhichAListMustNotContradict) {
  SliceList list = list_of(3);
  expect_error(ErrorCode::kBadInput, {"carry no z with a unit", "--pattern"},
               [&] { (void)slice_heights_um(ZNames{}, list); });
  list.z_um = {20, 10, 0};
  EXPECT_THAT(slice_heights_um(ZNames{}, list), ElementsAre(20.0, 10.0, 0.0));
  const ScratchDir scratch;
  test::write_text(scratch / "z.txt", "0\n10\n20\n");
  expect_error(ErrorCode::kBadInput, {"z.txt is in another order than the slices", "their names say 20 um and 10 um"},
               [&] {
                 (void)slice_heights_um(ZFile{scratch / "z.txt", LengthUnit::kMicrometre}, list);
               });
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
