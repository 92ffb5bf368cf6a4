#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "drivers/replay/slice_files.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using Names = std::vector<std::string>;
using test::ScratchDir;

/// Names in the order in which the slices must come.
struct Row {
  const char* what;
  Names slices;
  std::vector<double> z_um = {};       // empty: the names do not say it
  Names ignored = {};                  // further files
  std::string pattern = {};            // of --pattern
  std::vector<std::string> asks = {};  // words of the question; empty: there is none
  bool even = true;                    // a constant step fits the names
};

inline void PrintTo(const Row& row, std::ostream* out) { *out << row.what; }

/// first, first + step ... in the place of '#', with at least `digits` digits after the sign.
Names counted(const std::string& text, int count, int first = 0, int step = 1, std::size_t digits = 1) {
  Names names;
  for (int i = 0; i < count; ++i) {
    const int number = first + i * step;
    std::string name = std::to_string(std::abs(number));
    name.insert(0, digits > name.size() ? digits - name.size() : 0, '0');
    names.push_back(std::string(text).replace(text.find('#'), 1, (number < 0 ? "-" : "") + name));
  }
  return names;
}

Names joined(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Names grid(int planes, int channels) {
  Names names;
  for (int z = 0; z < planes; ++z) {
    names = joined(names, counted("Series001_z0" + std::to_string(z) + "_ch#.png", channels, 0, 1, 2));
  }
  return names;
}

Names upwards(const std::string& folder) {
  Names names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

const std::vector<Row> kRows{
    {"Counts", counted("slice_#.png", 12)},
    {"CountsWithZeros", counted("slice_#.tif", 12, 0, 1, 3)},
    {"CountsAfterADash", counted("scan-#.png", 11, 1)},
    {"CountsAfterZAndADash", counted("z-#.png", 11, 1, 1, 3)},
    {"CountsAfterAPoint", counted("scan2.#.png", 12, 1)},
    {"CountsFromZeroAfterADash", counted("z-#.png", 5)},
    {"NegativeZ", counted("z#.png", 21, -20, 10)},
    {"NegativeZWithUnit",
     counted("stack_z#um.png", 5, -50, 10),
     {-50, -40, -30, -20, -10},
     {},
     {},
     {"can be the sign of z or a separator", "stack_z{z_um}um.png", "stack_z-{z_um}um.png"}},
    {"SignedZWithUnit", counted("stack_z#um.png", 6, -20, 10), {-20, -10, 0, 10, 20, 30}},
    {"PlusAndMinus", {"z-10.png", "z+0.png", "z+10.png"}},
    {"MinusOfUnicode",
     {"z\xE2\x88\x92"
      "5um.png",
      "z0um.png", "z5um.png"},
     {-5, 0, 5}},
    {"AllNegativeWithoutUnit", counted("z#.png", 3, -30, 10), {}, {}, {}, {"z{z_um}.png", "z-{n}.png"}},
    {"DecimalMicrometres", {"z_0um.png", "z_0.5um.png", "z_1um.png", "z_1.5um.png"}, {0, 0.5, 1, 1.5}},
    {"DecimalMillimetres", {"1.15mm.png", "1.2mm.png", "1.25mm.png"}, {1150, 1200, 1250}},
    {"DecimalComma", {"z 0,5 \xC2\xB5m.png", "z 1,0 \xC2\xB5m.png", "z 1,5 \xC2\xB5m.png"}, {0.5, 1, 1.5}},
    {"Nanometres", counted("z#nm.png", 4, 0, 250), {0, 0.25, 0.5, 0.75}},
    {"DecimalsWithoutUnit", {"z_0.png", "z_0.5.png", "z_1.png", "z_1.5.png"}},
    {"DecimalsBelowOne", {"f0.1.png", "f0.2.png", "f0.3.png"}},
    {"DecimalOrTwoNumbers",
     {"f0.5.png", "f0.10.png", "f0.20.png"},
     {},
     {},
     {},
     {"decimal point or a separator", "f0.{n}.png"}},
    {"DescendingZ", {"s0_z20um.png", "s1_z10um.png", "s2_z0um.png", "s3_z-10um.png"}, {20, 10, 0, -10}},
    {"UnevenZ", {"z0um.png", "z10um.png", "z35um.png"}, {0, 10, 35}, {}, {}, {}, false},
    {"PositionsOfThePart", counted("x#um.png", 4, 0, 10)},
    {"ChannelAfterZ", counted("img_Z#_C0.png", 11, 0, 1, 2)},
    {"ObjectiveAtTheEnd", counted("S#_20x.png", 21, 0, 1, 2)},
    {"CountOfAll", counted("Slice # of 13.png", 13, 1)},
    {"OnePlaneFileOfAChannel", counted("Series001_z#_ch00.png", 21, 0, 1, 2)},
    {"ThreeChannels",
     grid(5, 3),
     {},
     {},
     {},
     {"more than one number varies", "'Series001_z{n}_ch00.png'", "'Series001_z00_ch{n}.png'"}},
    {"OneOfThreeChannels",
     counted("Series001_z0#_ch01.png", 5),
     {},
     joined(counted("Series001_z0#_ch00.png", 5), counted("Series001_z0#_ch02.png", 5)),
     "Series001_z{n}_ch01.png"},
    {"MicroManager", counted("img_000000000_Default_#.tif", 10, 0, 1, 3)},
    {"CountAndZ", {"001_z5um.png", "002_z7um.png", "003_z9um.png"}, {5, 7, 9}},
    {"CountAndZWithoutUnit", {"001_z5.png", "002_z7.png", "003_z9.png"}},
    {"CountUpZDown",
     {"001_90.png", "002_80.png", "003_70.png"},
     {},
     {},
     {},
     {"more than one number varies", "{n}_*.png", "*_{n}.png"}},
    {"SameZTwice", {"z0um_1.png", "z0um_2.png", "z5um_1.png", "z5um_2.png"}, {}, {}, {}, {"same z", "z{z_um}um_1.png"}},
    {"SameZTwiceInMillimetres",
     {"z0.1mm_1.png", "z0.1mm_2.png", "z0.2mm_1.png", "z0.2mm_2.png"},
     {},
     {},
     {},
     {"same z", "'z{z_mm}mm_1.png'"}},
    {"SameZTwiceInNanometres",
     {"z100nm_1.png", "z100nm_2.png", "z200nm_1.png", "z200nm_2.png"},
     {},
     {},
     {},
     {"same z", "'z{z_nm}nm_1.png'"}},
    {"SignOrSeparatorInNanometres", {"z-100nm.png", "z-200nm.png", "z-300nm.png"}, {}, {}, {}, {"'z{z_nm}nm.png'"}},
    {"TimeStamps", {"IMG_20261123_115959.jpg", "IMG_20261123_120001.jpg", "IMG_20261123_120003.jpg"}},
    {"TimeWithDashes", {"2026-11-30T23-59-58.png", "2026-11-30T23-59-59.png", "2026-12-01T00-00-01.png"}},
    {"TimeWithPoints",
     {"Shot 2026-11-23 at 12.00.58.png", "Shot 2026-11-23 at 12.01.01.png", "Shot 2026-11-23 at 12.01.04.png"}},
    {"TimeWithThousandths", {"c_20261123_120001_900.png", "c_20261123_120002_100.png", "c_20261123_120002_700.png"}},
    {"TimeAndCount", {"20261123_120001_1.png", "20261123_120003_2.png", "20261123_120009_3.png"}},
    {"CountLikeATime", {"20261123_000001.png", "20261123_000002.png", "20261123_000004.png"}, {}, {}, {}, {}, false},
    {"CountBeyondATime", counted("20261123_#.png", 9, 55, 1, 6)},
    {"RollingCounter", joined(counted("DSC_#.JPG", 10, 9990), counted("DSC_#.JPG", 11, 1, 1, 4))},
    {"RollingCounterWithZero", joined(counted("P#.JPG", 3, 9997), counted("P#.JPG", 3, 0, 1, 4))},
    {"RollingCounterWithAGap",
     joined(counted("DSC_#.JPG", 3, 9997), counted("DSC_#.JPG", 3, 2, 1, 4)),
     {},
     {},
     {},
     {},
     false},
    {"MissingNumber", {"s1.png", "s2.png", "s4.png"}, {}, {}, {}, {}, false},
    {"MixedCaseOfExtensions", {"s1.png", "s2.PNG", "s3.Png", "s4.png"}},
    {"SpellingsOfExtensions", {"s1.tif", "s2.TIFF", "s3.tiff"}},
    {"TwoFormats",
     joined(counted("s#.png", 5), counted("s#.jpg", 5)),
     {},
     {},
     {},
     {"s*.png (5 files)", "s*.jpg (5 files)"}},
    {"OneOfTwoFormats", counted("s#.jpg", 5), {}, counted("s#.png", 5), "s{n}.jpg"},
    {"OthersInTheFolder", counted("slice_#.png", 6), {}, {"truth.tiff", "mask_1.pgm", "preview.bmp"}},
    {"CopiesOfSlices",
     joined(counted("s#.png", 6), {"s1 (1).png"}),
     {},
     {},
     {},
     {"s1 (1).png", "may be a slice", "--pattern"}},
    {"FirstSliceWithoutANumber",
     joined(counted("img (#).png", 6, 1), {"img.png"}),
     {},
     {},
     {},
     {"also img.png", "no number", "'img ({n}).png'"}},
    {"TwoRuns", joined(counted("run1_#.png", 4), counted("run2_#.png", 4)), {}, {}, {}, {"run1_{n}.png"}},
    {"TwoFamilies",
     joined(counted("left#.png", 5), counted("right#.png", 4)),
     {},
     {},
     {},
     {"left*.png", "right*.png", "--pattern"}},
    {"SameNumberTwice", {"a0.png", "a1.png", "a01.png"}, {}, {}, {}, {"a01.png and a1.png", "same number"}},
    {"PatternOfZ",
     {"z_-0.5um_b.png", "z_0um_a.png", "z_0.5um_c.png"},
     {-0.5, 0, 0.5},
     {"z_1um.png"},
     "z_{z_um}um_*.png"},
    {"PatternOfMillimetres", {"p1_0.10.png", "p2_0.12.png", "p3_0.14.png"}, {100, 120, 140}, {}, "p*_{z_mm}.png"},
    {"PatternOfNanometres",
     {"z100nm_1.png", "z200nm_1.png", "z300nm_1.png"},
     {0.1, 0.2, 0.3},
     {"z100nm_2.png"},
     "z{z_nm}nm_1.png"},
    {"PatternOfCountAndZ", {"1_z9.PNG", "2_z8.png", "3_z7.png"}, {9, 8, 7}, {"x.png"}, "{n}_z{z_um}.png"},
    {"PatternThatSeparates", counted("z-#um.png", 3, 10, 10), {10, 20, 30}, {}, "z-{z_um}um.png"},
    {"PatternForNothing", counted("s#.png", 4), {}, {}, "t{n}.png", {"matches 0 of the 4 image files", "s0.png"}},
    {"PatternOfTwoFamilies", {"a1.png", "b1.png"}, {}, {}, "*{n}.png", {"a1.png and b1.png", "'*'"}},
    {"PatternWithoutANumber", counted("s#.png", 4), {}, {}, "s*.png", {"needs {n}, {z_um}, {z_mm} or {z_nm}"}},
    {"PatternWithAnUnknownField", counted("s#.png", 4), {}, {}, "s{t}.png", {"{n}, {z_um}, {z_mm}"}},
};

TEST(SliceNamesOfTwoRuns, AreAskedForWithPatternsThatMakeAStack) {
  const ScratchDir scratch;
  for (const std::string& name : joined(counted("run1_#.png", 4), counted("run2_#.png", 4))) {
    test::write_text(scratch / name, "");
  }
  try {
    (void)find_slices(scratch.path());
    FAIL() << "no question";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'run1_{n}.png'"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("run{n}")));
  }
}

class SliceNames : public testing::TestWithParam<Row> {};

TEST_P(SliceNames, GiveOrderAndZOrAClearQuestion) {
  const Row& row = GetParam();
  const ScratchDir scratch;
  for (const std::string& name : joined(row.slices, row.ignored)) test::write_text(scratch / name, "");
  const std::size_t files = upwards(scratch.path()).size();
  ASSERT_EQ(files, row.slices.size() + row.ignored.size()) << "every name is another file";

  if (!row.asks.empty()) {
    try {
      const SliceList list = find_slices(scratch.path(), {row.pattern, {}, {}});
      FAIL() << "no question, but " << list.description;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadInput);
      for (const std::string& words : row.asks) EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
    return;
  }
  const SliceList list = find_slices(scratch.path(), {row.pattern, {}, {}});

  Names found;
  for (const SliceLocation& slice : list.slices) found.push_back(slice.name());
  EXPECT_EQ(found, row.slices) << list.description;
  EXPECT_THAT(list.z_um, testing::Pointwise(testing::DoubleNear(1e-9), row.z_um));
  EXPECT_THAT(list.ignored, testing::UnorderedElementsAreArray(row.ignored));
  EXPECT_EQ(static_cast<std::size_t>(list.used_files) + list.ignored.size(), files);
  EXPECT_EQ(list.gap.empty(), row.even) << list.gap;
}

INSTANTIATE_TEST_SUITE_P(Families, SliceNames, testing::ValuesIn(kRows),
                         [](const auto& row) { return std::string(row.param.what); });

TEST(SliceNames, TellWhereTheClockPausedForOneSliceMore) {
  const ScratchDir scratch;
  for (const char* second : {"00", "05", "10", "20", "25"}) {
    test::write_text(scratch / (std::string("20261123_1200") + second + ".png"), "");
  }
  EXPECT_THAT(find_slices(scratch.path()).doubt,
              testing::HasSubstr("between 20261123_120010.png and 20261123_120020.png passed 10 s, usually 5 s"));
}

}  // namespace
}  // namespace fvd
