#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/export/height_tiff.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "tests/daemon/surface_files/byte_text.hpp"
#include "tests/daemon/surface_files/peak_memory.hpp"
#include "tests/daemon/surface_files/sample_surface.hpp"
#include "tests/daemon/surface_files/zip_builder.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::little_all;
using test::SdfText;
using test::X3pText;
using test::ZipEntries;

/// A file that must be refused, and what the refusal says.
struct BadFile {
  std::string name;  ///< of the case
  std::string ending;
  std::function<void(const std::filesystem::path&)> make;
  std::string says;
  SurfaceReadOptions options = {};
};
void PrintTo(const BadFile& file, std::ostream* out) { *out << file.name; }

const std::string kPoints = little_all<double>(0.0, 1e-6, 2e-6, 3e-6, 4e-6, 5e-6);

BadFile bytes(const std::string& name, const std::string& ending, const std::string& content, const std::string& says,
              const SurfaceReadOptions& options = {}) {
  return {name, ending, [content](const std::filesystem::path& path) { test::write_text(path, content); }, says,
          options};
}

BadFile archive(const std::string& name, const ZipEntries& entries, const std::string& says) {
  return {name, "x3p", [entries](const std::filesystem::path& path) { test::build_zip(path, entries); }, says};
}

/// An X3P whose description is wrong in one place.
BadFile x3p(const std::string& name, const std::function<void(X3pText&)>& spoil, const std::string& says,
            const std::string& points = kPoints, const std::string* valid = nullptr) {
  X3pText text;
  spoil(text);
  return archive(name, text.entries(points, valid), says);
}

ZipEntries with(const std::string& name, const std::string& content) {
  ZipEntries entries = X3pText{}.entries(kPoints);
  entries.emplace_back(name, content);
  return entries;
}

std::string good(const std::string& format) {
  return surface_bytes(*find_surface_writer(format), surface_view(test::sample_surface(), {}));
}

/// The bytes with `count` of them at `place` replaced.
std::string patched(std::string content, std::size_t place, const std::string& by) {
  return content.replace(place, by.size(), by);
}
std::string replaced(std::string content, const std::string& old_text, const std::string& new_text) {
  const auto place = content.find(old_text);
  if (place == std::string::npos) throw std::logic_error("nothing to replace by " + new_text);
  return content.replace(place, old_text.size(), new_text);
}

/// An archive made by libzip, as bytes, to be damaged.
std::string zip_bytes(const ZipEntries& entries) {
  const test::ScratchDir scratch;
  test::build_zip(scratch / "a", entries);
  return test::read_text(scratch / "a");
}
/// The name of one entry replaced by another of the same length, in both places.
std::string renamed(const std::string& old_name, const std::string& new_name) {
  std::string all = zip_bytes(with(old_name, "x"));
  for (auto place = all.find(old_name); place != std::string::npos; place = all.find(old_name)) {
    all.replace(place, old_name.size(), new_name);
  }
  return all;
}

/// Another bit in the heights of an archive.
std::string damaged_points() {
  const std::string name = "bindata/data.bin";
  const std::string whole = good("x3p");
  const auto head = whole.find(name, whole.find(name) + 1);  // the first stands in main.xml
  return patched(whole, head + name.size() + 3, "\x7F");
}

/// The directory tells another size of the first entry. packed: "x" = the true one.
std::string with_size(const std::string& size, const std::string& packed) {
  std::string whole = zip_bytes(X3pText{}.entries(kPoints));
  const auto entry = whole.find(std::string("PK\1\2", 4));
  if (packed.size() == 4) whole = patched(whole, entry + 20, packed);
  return patched(whole, entry + 24, size);
}

std::string gsf(const std::string& lines, std::size_t points = 6) {
  std::string file = "Gwyddion Simple Field 1.0\n" + lines;
  file.append(4 - file.size() % 4, '\0');
  return file + std::string(points * 4, '\0');
}

std::string sdf(const std::function<void(SdfText&)>& spoil, const std::string& points) {
  SdfText text;
  spoil(text);
  return text.bytes() + points;
}

std::string ascii_sdf(const std::string& lines, const std::string& points) {
  return "aISO-1.0\n" + lines + "*\n" + points;
}

std::string tiff() { return encode_height_tiff(test::sample_surface().height_m, {"fvd", "", {}, {}}); }

void add_x3p(std::vector<BadFile>& files) {
  const std::string short_mask("\xFF\xFF", 2);
  const std::string mask("\xFF", 1);
  const auto axis_z = [](const char* text) { return [text](X3pText& x3p_text) { x3p_text.axis_z = text; }; };
  const auto matrix = [](const char* text) { return [text](X3pText& x3p_text) { x3p_text.matrix = text; }; };
  const auto axis_x = [](const char* text) { return [text](X3pText& x3p_text) { x3p_text.axis_x = text; }; };
  files.insert(
      files.end(),
      {
          x3p(
              "X3pOtherRevision", [](X3pText& t) { t.revision = "ISO5436 - 2011"; }, "Revision"),
          x3p(
              "X3pProfile", [](X3pText& t) { t.feature = "PRF"; }, "FeatureType"),
          x3p(
              "X3pPointCloud", [](X3pText& t) { t.feature = "PCL"; }, "FeatureType"),
          x3p("X3pAbsoluteAxis", axis_x("<AxisType>A</AxisType><DataType>D</DataType>"), "CX/AxisType"),
          x3p("X3pNegativePitch", axis_x("<AxisType>I</AxisType><Increment>-5e-7</Increment>"), "CX/Increment"),
          x3p("X3pPitchNan", axis_x("<AxisType>I</AxisType><Increment>NaN</Increment>"), "CX/Increment"),
          x3p("X3pPitchZero", axis_x("<AxisType>I</AxisType><Increment>0</Increment>"), "CX/Increment"),
          x3p("X3pNoPitch", axis_x("<AxisType>I</AxisType>"), "CX/Increment: it is missing"),
          x3p("X3pTwoPitches", axis_x("<AxisType>I</AxisType><Increment>1e-6</Increment><Increment>2e-6</Increment>"),
              "twice"),
          x3p("X3pUnknownType", axis_z("<AxisType>A</AxisType><DataType>Q</DataType>"), "CZ/DataType"),
          x3p("X3pIntegerWithoutIncrement", axis_z("<AxisType>A</AxisType><DataType>I</DataType>"), "CZ/Increment"),
          x3p("X3pHeightIncrementZero", axis_z("<AxisType>A</AxisType><DataType>D</DataType><Increment>0</Increment>"),
              "CZ/Increment"),
          x3p("X3pOffsetInfinite", axis_z("<AxisType>A</AxisType><DataType>D</DataType><Offset>inf</Offset>"),
              "CZ/Offset"),
          x3p(
              "X3pRotated", [](X3pText& t) { t.rotation = "<Rotation><r11>0</r11></Rotation>"; }, "Rotation/r11"),
          x3p(
              "X3pRotationWithoutNumbers", [](X3pText& t) { t.rotation = "<Rotation/>"; }, "Rotation/r11"),
          x3p("X3pTwoLayers", matrix("<SizeX>3</SizeX><SizeY>1</SizeY><SizeZ>2</SizeZ>"), "SizeZ"),
          x3p("X3pHuge", matrix("<SizeX>1000000000</SizeX><SizeY>1000000000</SizeY><SizeZ>1</SizeZ>"),
              "MatrixDimension"),
          x3p("X3pOverflow", matrix("<SizeX>99999999999999999999</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"), "SizeX"),
          x3p("X3pManyPoints", matrix("<SizeX>1000000</SizeX><SizeY>1000000</SizeY><SizeZ>1</SizeZ>"),
              "MatrixDimension"),
          x3p("X3pNegativeSize", matrix("<SizeX>-3</SizeX><SizeY>-2</SizeY><SizeZ>1</SizeZ>"), "MatrixDimension"),
          x3p("X3pSizeOfNoNumber", matrix("<SizeX>3x</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"), "SizeX"),
          x3p("X3pFewPoints", matrix("<SizeX>4</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"), "48 bytes in place of 64"),
          x3p("X3pManyBytes", matrix("<SizeX>2</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"), "48 bytes in place of 32"),
          x3p(
              "X3pWrongPointSum", [](X3pText& t) { t.points_md5 = std::string(32, '0'); }, "its MD5 sum is"),
          x3p(
              "X3pNoPointSum", [](X3pText& t) { t.points_md5 = "none"; }, "MD5ChecksumPointData"),
          x3p(
              "X3pWrongMainSum", [](X3pText& t) { t.main_md5 = std::string(32, 'a'); }, "main.xml'"),
          x3p(
              "X3pWrongMaskSum", [](X3pText& t) { t.valid_md5 = std::string(32, '0'); }, "valid.bin'", kPoints, &mask),
          x3p(
              "X3pMaskTooLong", [](X3pText&) {}, "2 bytes in place of 1", kPoints, &short_mask),
          x3p(
              "X3pLinkToNothing", [](X3pText& t) { t.points_link = "bindata/other.bin"; }, "it is missing"),
          x3p(
              "X3pPointList", [](X3pText& t) { t.more_in_record_3 = "<ListDimension>6</ListDimension>"; },
              "ListDimension"),
          x3p(
              "X3pDataInXml", [](X3pText& t) { t.more_in_record_3 = "<DataList/>"; }, "DataList"),
          x3p(
              "X3pEntities", [](X3pText& t) { t.prologue += "<!DOCTYPE x [<!ENTITY a \"b\">]>"; }, "document type"),
          x3p(
              "X3pNoXml", [](X3pText& t) { t.revision = "<"; }, "main.xml, byte"),
      });
}

void add_archives(std::vector<BadFile>& files) {
  files.insert(
      files.end(),
      {
          archive("X3pOtherRoot", {{"main.xml", "<ISO5436_3/>"}}, "root"),
          archive("X3pWithoutMain", {{"other.xml", "<a/>"}}, "'main.xml': it is missing"),
          archive("X3pLargeMain", {{"main.xml", std::string((1U << 20U) - 1, ' ') + kPoints + "<a>"}}, ""),
          archive(
              "X3pWithoutSum",
              [] {
                auto e = X3pText{}.entries(kPoints);
                e.pop_back();
                return e;
              }(),
              "md5checksum.hex"),
          archive("X3pBomb", with("zeros", std::string(1U << 20U, '\0')), "compressed by more than 200"),
          bytes("X3pNameUpwards", "x3p", renamed("abcd", "../a"), "leads out"),
          bytes("X3pNameUpwardsInside", "x3p", renamed("abcdefg", "a/../bc"), "leads out"),
          bytes("X3pNameAbsolute", "x3p", renamed("abcd", "/etc"), "leads out"),
          bytes("X3pNameOfADrive", "x3p", renamed("abcd", "C:ab"), "leads out"),
          bytes("X3pNameWithBackslash", "x3p", renamed("abcd", "..\\a"), "leads out"),
          bytes("X3pTwoMains", "x3p", renamed("main.xmk", "main.xml"), "twice"),
          bytes("X3pTruncated", "x3p", good("x3p").substr(0, 700), "archive"),
          bytes("X3pDamaged", "x3p", damaged_points(), "damaged"),
          bytes("X3pManyEntries", "x3p", patched(good("x3p"), good("x3p").size() - 12, "\xFF\xFE"), "65279 entries"),
          bytes("X3pEntryOfFourGib", "x3p", with_size("\xFF\xFF\xFF\xFE", "x"), "compressed by more than 200"),
          bytes("X3pEntryLongerThanTheFile", "x3p", with_size("\xFF\xFF\xFF\x0E", "\xFF\xFF\xFF\x0E"),
                "longer than the file"),
          bytes("X3pShorterThanItsLocator", "x3p", std::string("PK\6\6....PK\6\7", 12) + std::string(20, '\0'),
                "archive"),
          bytes("X3pOnlyMagic", "x3p", "PK\3\4", "archive"),
      });
}

void add_gsf(std::vector<BadFile>& files) {
  const std::string lines = "XRes = 3\nYRes = 2\nXReal = 1.5e-6\nYReal = 5e-07\nXYUnits = m\nZUnits = m\n";
  const std::string whole = gsf(lines);
  files.insert(
      files.end(),
      {
          bytes("GsfTruncated", "gsf", whole.substr(0, whole.size() - 1), "in place of"),
          bytes("GsfTooLong", "gsf", whole + "x", "in place of"),
          bytes("GsfHeaderWithoutEnd", "gsf", "Gwyddion Simple Field 1.0\n" + lines, "no NUL"),
          bytes("GsfPaddingOfLetters", "gsf",
                replaced(gsf("a = b\n" + lines), std::string("\0\0", 2), std::string("\0x", 2)), "filled up"),
          bytes("GsfOtherVersion", "gsf", "Gwyddion Simple Field 2.0\n", "does not begin"),
          bytes("GsfWithoutSize", "gsf", gsf(replaced(lines, "XRes = 3\n", "")), "XRes"),
          bytes("GsfHuge", "gsf",
                gsf(replaced(replaced(lines, "XRes = 3", "XRes = 1000000000"), "YRes = 2", "YRes = 1000000000")),
                "XRes and YRes"),
          bytes("GsfSizeOverflows", "gsf", gsf(replaced(lines, "XRes = 3", "XRes = 99999999999999999999")), "XRes"),
          bytes("GsfNegativeSize", "gsf", gsf(replaced(lines, "XRes = 3", "XRes = -3")), "below 1"),
          bytes("GsfNegativePitch", "gsf", gsf(replaced(lines, "1.5e-6", "-1.5e-6")), "XReal"),
          bytes("GsfPitchNan", "gsf", gsf(replaced(lines, "1.5e-6", "nan")), "XReal"),
          bytes("GsfPitchOfNoNumber", "gsf", gsf(replaced(lines, "1.5e-6", "1,5e-6")), "XReal"),
          bytes("GsfHeightsInVolt", "gsf", gsf(replaced(lines, "ZUnits = m", "ZUnits = V")), "ZUnits"),
          bytes("GsfWithoutHeightUnit", "gsf", gsf(replaced(lines, "ZUnits = m\n", "")), "ZUnits"),
          bytes("GsfPitchInSeconds", "gsf", gsf(replaced(lines, "XYUnits = m", "XYUnits = s")), "XYUnits"),
          bytes("GsfTwoSizes", "gsf", gsf(lines + "XRes = 3\n"), "twice"),
          bytes("GsfLineWithoutValue", "gsf", gsf(lines + "oops\n"), "no '='"),
          bytes("GsfOtherPitchThanTheCallers", "gsf", whole, "given is", {0.6, 0.25}),
      });
}

void add_sdf(std::vector<BadFile>& files) {
  const std::string points = little_all<std::int16_t>(0, 1, 2, 3, 4, 5);
  const std::string lines =
      "NumPoints = 3\nNumProfiles = 2\nXscale = 5e-7\nYscale = 2.5e-7\nZscale = 1e-9\nDataType = 6\n";
  files.insert(files.end(), {
    bytes("SdfTruncated", "sdf", sdf([](SdfText&) {}, points.substr(1)), "file ends"),
    bytes("SdfHeaderTruncated", "sdf", sdf([](SdfText&) {}, "").substr(0, 60), "missing"),
    bytes("SdfShiftedByALongerHeader", "sdf", sdf([](SdfText&) {}, points + std::string("\1\2\3\4\5\6\7\x0E", 8)), "behind the heights"),
    bytes("SdfMuchBehind", "sdf", sdf([](SdfText&) {}, points + std::string(100000, ' ')), "behind the heights"),
    bytes("SdfNoPoints", "sdf", sdf([](SdfText& t) { t.width = 0; }, ""), "below 1"),
    bytes("SdfPitchNan", "sdf", sdf([](SdfText& t) { t.x_scale = std::nan(""); }, points), "Xscale"),
    bytes("SdfNegativePitch", "sdf", sdf([](SdfText& t) { t.y_scale = -1e-6; }, points), "Yscale"),
    bytes("SdfInfinitePitch", "sdf", sdf([](SdfText& t) { t.y_scale = HUGE_VAL; }, points), "Yscale"),
    bytes("SdfHeightScaleZero", "sdf", sdf([](SdfText& t) { t.z_scale = 0.0; }, points), "Zscale"),
    bytes("SdfHeightScaleNan", "sdf", sdf([](SdfText& t) { t.z_scale = std::nan(""); }, points), "Zscale"),
    bytes("SdfCompressed", "sdf", sdf([](SdfText& t) { t.compression = 1; }, points), "Compression"),
    bytes("SdfUnknownType", "sdf", sdf([](SdfText& t) { t.type = 8; }, points), "DataType"),
    bytes("SdfWithACheck", "sdf", sdf([](SdfText& t) { t.check = 1; }, points), "CheckType"),
    bytes("SdfOtherVersion", "sdf", sdf([](SdfText& t) { t.magic = "bISO-9.0"; }, points), "versions"),
    bytes("SdfAsciiFewHeights", "sdf", ascii_sdf(lines, "1 2 3 4 5\n*\n"), "fewer heights"),
    bytes("SdfAsciiManyHeights", "sdf", ascii_sdf(lines, "1 2 3 4 5 6 7\n*\n"), "more heights"),
    bytes("SdfAsciiNoNumber", "sdf", ascii_sdf(lines, "1 2 x3 4 5 6\n*\n"), "point 2: 'x3' is no number"),
    bytes("SdfAsciiLongNumber", "sdf", ascii_sdf(lines, std::string(1000, '1')), "too long"),
    bytes("SdfAsciiHuge", "sdf", ascii_sdf(replaced(replaced(lines, "s = 3", "s = 1000000000"), "Profiles = 2", "Profiles = 1000000000"), "1"), "NumPoints"),
    bytes("SdfAsciiMuchTooShort", "sdf", ascii_sdf(replaced(replaced(lines, "s = 3", "s = 20000"), "Profiles = 2", "Profiles = 20000"), "1"), "too short"),
    bytes("SdfAsciiWithoutScale", "sdf", ascii_sdf(replaced(lines, "Xscale = 5e-7\n", ""), "1 2 3 4 5 6"), "Xscale: it is missing"),
    bytes("SdfAsciiHeaderWithoutEnd", "sdf", "aISO-1.0\n" + lines, "within the header"),
    bytes("SdfAsciiTwoSizes", "sdf", ascii_sdf(lines + "NumPoints = 4\n", "1 2 3 4 5 6"), "twice"),
    bytes("SdfAsciiLongLine", "sdf", ascii_sdf(std::string(100000, 'x') + "\n", ""), "longer than"),
    bytes("SdfAsciiManyLines", "sdf", [] { std::string t = "aISO-1.0\n"; for (int i = 0; i < 99; ++i) t += "k" + std::to_string(i) + " = 1\n"; return t; }(), "too many lines"),
  });
}

void add_others(std::vector<BadFile>& files) {
  const SurfaceReadOptions pitch{1.0, 1.0};
  const std::string sized = tiff();
  files.insert(
      files.end(),
      {
          bytes("Nothing", "x3p", "", "none of"),
          bytes("Text", "dat", "hello", "none of"),
          {"AFileThatIsNotThere", "gsf", [](const std::filesystem::path&) {}, "No such file"},
          {"AFolderWithoutResult", "gsf",
           [](const std::filesystem::path& path) { std::filesystem::create_directory(path); }, "result.json"},
          bytes("TiffWithoutPitch", "tiff", sized, "must be given"),
          bytes("TiffWithPitchNan", "tiff", sized, "not within", {std::nan(""), 1.0}),
          bytes("TiffWithNegativePitch", "tiff", sized, "not within", {1.0, -1.0}),
          bytes("TiffTruncated", "tiff", sized.substr(0, sized.size() / 2), "", pitch),
          bytes("TiffOfIntegers", "tiff",
                replaced(sized, std::string("\x53\x01\x03\0\1\0\0\0\3\0", 10),
                         std::string("\x53\x01\x03\0\1\0\0\0\1\0", 10)),
                "no floats", pitch),
          bytes(
              "TiffHuge", "tiff",
              replaced(replaced(sized, std::string("\0\1\3\0\1\0\0\0\7\0\0\0", 12),
                                std::string("\0\1\4\0\1\0\0\0\0\xCA\x9A\x3B", 12)),
                       std::string("\1\1\3\0\1\0\0\0\5\0\0\0", 12), std::string("\1\1\4\0\1\0\0\0\0\xCA\x9A\x3B", 12)),
              "", pitch),
          bytes("TiffOnlyMagic", "tiff", std::string("II*\0", 4), "", pitch),
          bytes("CsvWithoutUnit", "csv", "1,2\n3,4\n", "unit", pitch),
          bytes("CsvInInches", "csv", "# unit = in\n1,2\n3,4\n", "unit", pitch),
          bytes("CsvWithoutPitch", "csv", "# unit = um\n1,2\n3,4\n", "must be given"),
          bytes("CsvPitchZero", "csv", "# unit = um\n# pitch_x_um = 0\n# pitch_y_um = 1\n1,2\n3,4\n", "pitch_x_um"),
          bytes("CsvPitchOfNoNumber", "csv", "# unit = um\n# pitch_x_um = a\n1,2\n", "pitch_x_um"),
          bytes("CsvUnequalRows", "csv", "# unit = um\n1,2\n3\n", "line 3", pitch),
          bytes("CsvOfWords", "csv", "# unit = um\n1,2\n3,four\n", "line 3, column 2", pitch),
          bytes("CsvEmpty", "csv", "# unit = um\n", "no row", pitch),
          bytes("CsvWithNul", "csv", std::string("# unit = um\n1,\0", 15), "NUL", pitch),
          bytes("CsvTwoUnits", "csv", "# unit = um\n# unit = nm\n1\n", "twice", pitch),
      });
}

std::vector<BadFile> bad_files() {
  std::vector<BadFile> files;
  add_x3p(files);
  add_archives(files);
  add_gsf(files);
  add_sdf(files);
  add_others(files);
  return files;
}

class BadFiles : public testing::TestWithParam<BadFile> {};

TEST_P(BadFiles, AreRefusedWithFilePlaceAndReason) {
  const test::ScratchDir scratch;
  const auto path = scratch / ("bad." + GetParam().ending);
  GetParam().make(path);
  const test::PeakMemory memory;

  test::expect_error(ErrorCode::kSurfaceFile,
                     {path.string() + (GetParam().ending == "gsf" ? "" : ": "), GetParam().says},
                     [&] { (void)read_surface(path, GetParam().options); });

  RecordProperty("reader_peak_mib", std::to_string(memory.risen_mib()));
  EXPECT_LE(memory.risen_mib(), 64.0);
}

INSTANTIATE_TEST_SUITE_P(Table, BadFiles, testing::ValuesIn(bad_files()),
                         [](const auto& one) { return one.param.name; });

TEST(BadFilesTable, HasMoreThanForty) { EXPECT_GT(bad_files().size(), 100U); }

}  // namespace
}  // namespace fvd
