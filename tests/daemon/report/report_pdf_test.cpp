#include "daemon/report/report_pdf.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/daemon/report/sample_report.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto place = text.find(word); place != std::string::npos; place = text.find(word, place + 1)) ++found;
  return found;
}

/// Pages are plain objects of the version that is written.
std::size_t pages(const std::string& pdf) { return count(pdf, "/Type /Page\n") + count(pdf, "/Type /Page "); }

std::string report_of(const Result& result) {
  const Surface surface = test::groove_surface();
  return report_pdf(result, picture_surface(surface));
}

/// The result with so many values more.
Result with_values(int more) {
  Result result = test::sample_report_result();
  EvaluatedMeasurement many = result.evaluation->measurements.at("land");
  many.values.clear();
  for (int i = 0; i < more; ++i) many.values["v" + std::to_string(100 + i)] = test::value_of(i, "um", 0.1);
  many.main_value = "v100";
  result.evaluation->order.push_back("many");
  result.evaluation->measurements["many"] = many;
  return result;
}

bool has_pdftotext() { return std::system("command -v pdftotext >/dev/null 2>&1") == 0; }

std::string words_of(const std::string& pdf) {
  const ScratchDir scratch;
  test::write_text(scratch / "report.pdf", pdf);
  const std::string command =
      "pdftotext -layout '" + (scratch / "report.pdf").string() + "' '" + (scratch / "report.txt").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return test::read_text(scratch / "report.txt");
}

TEST(ReportPdf, GivesTheSameBytesForTheSameResult) {
  const Result result = test::sample_report_result();

  const std::string first = report_of(result);
  const std::string second = report_of(result);

  EXPECT_TRUE(first.starts_with("%PDF-1.5"));
  EXPECT_TRUE(first == second);
}

TEST(ReportPdf, TellsTheTimeOfTheResultAndNoOther) {
  Result result = test::sample_report_result();
  const std::string first = report_of(result);
  EXPECT_THAT(first, HasSubstr("20231114221320"));
  EXPECT_THAT(first, Not(HasSubstr("ModDate")));

  result.provenance.created += std::chrono::hours(24);

  EXPECT_FALSE(first == report_of(result));
}

TEST(ReportPdf, IsOnePageWithUpToFourteenValues) {
  EXPECT_EQ(pages(report_of(test::sample_report_result())), 1U);
  EXPECT_EQ(pages(report_of(with_values(kValuesOnFirstPage - 4))), 1U) << "the sample has four values";
  EXPECT_EQ(pages(report_of(with_values(kValuesOnFirstPage - 3))), 2U);
  EXPECT_EQ(pages(report_of(with_values(200))), 5U);
}

TEST(ReportPdf, GoesOnUntilTheLastOfManyLongConditions) {
  Result result = test::sample_report_result();
  for (int i = 0; i < 60; ++i) {
    std::string text;
    for (int word = 0; word < 60; ++word) text += "warned ";
    result.warnings.push_back({"w", text + std::to_string(i)});
  }

  const std::string pdf = report_of(result);

  EXPECT_EQ(pages(pdf), 3U);
  if (has_pdftotext()) {
    EXPECT_THAT(words_of(pdf), testing::AllOf(HasSubstr("warned 59"), HasSubstr("page 3 of 3")));
  }
}

TEST(ReportPdf, DoesNotFailWhereNothingIsKnown) {
  Surface surface = test::groove_surface(30, 20);
  for (float& height : surface.height_m.pixels()) height = std::numeric_limits<float>::quiet_NaN();
  PictureSurface picture = picture_surface(surface);
  picture.pitch_x_um = picture.pitch_y_um = std::nullopt;
  Result empty;
  empty.job.part_id = "a \xff\x01 \n b";

  EXPECT_EQ(pages(report_pdf(empty, picture)), 1U);
}

TEST(ReportPdf, SaysAsTextWhatWasMeasuredAndUnderWhichConditions) {
  if (!has_pdftotext()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const std::string words = words_of(report_of(test::sample_report_result()));

  for (const char* expected : {"part-42",
                               "PASS",
                               "SIMULATED",
                               "J7, number 4711",
                               "2023-11-14 22:13:20 UTC",
                               "groove 0123456789ab",
                               "camera and stage",
                               "Calibration",
                               "49.985",
                               "0.048",
                               "(k 2.00)",
                               "µm",
                               "49.5 … 50.5",
                               "0.412",
                               "the autocorrelation does not fall",
                               "18230 points, 99.8 % valid",
                               "noise floor Sq 0.21 µm",
                               "U does not contain: temperature, lateral",
                               "level (form plane, regions land): 812 points used, 3 removed",
                               "iso14253_1",
                               "the light varies by 3 %",
                               "fvd 1.2.3",
                               "surface SHA-256",
                               "heights shown 50.0 µm, to scale",
                               "height / µm",
                               "x / µm",
                               "step: mean over 200 µm",
                               "measured z / µm",
                               "page 1 of 1"}) {
    EXPECT_THAT(words, HasSubstr(expected));
  }
  EXPECT_THAT(words, Not(HasSubstr("0123456789abc"))) << "twelve digits";
  EXPECT_THAT(words, Not(HasSubstr(" um"))) << "micrometres are written with their letter";
}

TEST(ReportPdf, NamesTheCalibrationWithItsDayAndWhatHasLapsed) {
  if (!has_pdftotext()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  Result result = test::sample_report_result();  // of 2023-11-14
  result.calibration = test::whole_calibration();
  EXPECT_THAT(words_of(report_of(result)), testing::AllOf(HasSubstr("cal-0003, 2026-11-29"), Not(HasSubstr("lapsed"))));

  result.calibration->z->origin.renew_by = "2023-11-14";
  result.calibration->lateral->origin.renew_by = "2023-11-13";

  EXPECT_THAT(words_of(report_of(result)), HasSubstr("cal-0003, 2026-11-29, lapsed: lateral"));
}

TEST(ReportPdf, ShowsEachVerdictInItsWord) {
  if (!has_pdftotext()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  for (const auto& [verdict, word] :
       {std::pair{Verdict::kPass, "PASS"}, std::pair{Verdict::kFail, "FAIL"},
        std::pair{Verdict::kUncertain, "UNCERTAIN"}, std::pair{Verdict::kInvalid, "INVALID"}}) {
    Result result = test::sample_report_result();
    result.verdict = verdict;
    result.evaluation->measurements["step"].values["height_um"].verdict = verdict;

    EXPECT_EQ(count(words_of(report_of(result)), word), 2U) << word;
  }
}

}  // namespace
}  // namespace fvd
