/// The page of a study: one, and the same bytes each time.

#include "daemon/study/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "daemon/study/studies.hpp"
#include "tests/daemon/study/study_bench.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

class AStudysPage : public test::AStudyDesk {
 protected:
  StudyPage page_of(const std::string& kind, StudyInput input) {
    const StudySources from = sources();
    StudyJobs jobs(from, {});
    const StudyRequest request{kind, "anna", std::move(input)};
    StudyDraft draft = draft_of_jobs(request, jobs);
    note_request(request, draft.study);
    draft.study.id = "study-0007";
    draft.study.time = "2026-11-29T20:15:00.000Z";
    StudyPage page = study_page(draft);
    set_identity(draft.study, page);
    return page;
  }
  std::vector<std::string> keep_scans(int scans) {
    std::vector<std::string> ids;
    std::mt19937 engine(1);
    std::normal_distribution<double> noise(0.0, 0.2);
    for (int i = 0; i < scans; ++i) {
      ids.push_back("n" + std::to_string(i));
      keep(surface_data(ids.back(), [&](int x, int) { return 0.1 * x + noise(engine); }));
    }
    return ids;
  }
  std::vector<std::string> know_values(int jobs) {
    std::vector<std::string> ids;
    for (int i = 0; i < jobs; ++i) {
      ids.push_back("a-long-name-of-a-job-" + std::to_string(i));
      know_value(ids.back(), 50.0 + 0.1 * (i / 6) + 0.01 * (i % 3), 0.02);
    }
    return ids;
  }
  static void expect_one_page(const StudyPage& page) {
    const std::string pdf = study_pdf(page);

    EXPECT_EQ(count(pdf, "/Type /Page\n") + count(pdf, "/Type /Page "), 1U) << page.title;
    EXPECT_EQ(pdf, study_pdf(page)) << page.title;
    EXPECT_NE(pdf.find("/CreationDate (20261129201500Z)"), std::string::npos);
  }
};

TEST_F(AStudysPage, IsOneForNoise) {
  const StudyPage page = page_of("verify.noise", NoiseRequest{keep_scans(3), {}});

  expect_one_page(page);
  EXPECT_TRUE(page.map);
  EXPECT_TRUE(page.simulated);
}

TEST_F(AStudysPage, IsOneForSteps) {
  StepRequest request;
  for (const std::string& id : know_values(12)) {
    const double reference_um = 10.0 * static_cast<double>(request.steps.size() + 1);
    know_value(id, reference_um + 0.01, 0.02);
    request.steps.push_back({id, {"step", "height_um"}, reference_um, 0.02});
  }
  const StudyPage page = page_of("calibrate.z", request);

  expect_one_page(page);
  EXPECT_EQ(page.facts[1].second, "2026-11-29 20:15:00 UTC");
  ASSERT_EQ(page.rows[0].name, "alpha_z");
  EXPECT_EQ(page.rows[0].value, "1.00012") << "as many digits as U tells";
  EXPECT_EQ(page.rows[0].uncertainty, "0.00022  (1.96)");
  EXPECT_THAT(page.subtitle, HasSubstr("not valid before they are accepted"));
}

TEST_F(AStudysPage, IsOneForAGaugeOfManyJobs) {
  RrRequest request;
  request.parts = 10;
  request.operators = 3;
  request.trials = 3;
  request.jobs = know_values(90);
  request.what = {"step", "height_um"};
  request.tolerance = 1.0;

  expect_one_page(page_of("gauge.rr", request));
}

TEST_F(AStudysPage, IsOneForACrossGridAndShowsItsDeviations) {
  const auto share = [](double from_middle) { return std::clamp((11.0 - std::abs(from_middle)) / 6.0, 0.0, 1.0); };
  keep(surface_data(
      "grid",
      [&share](int x, int y) {
        const double bent = x + 0.2 * std::sin(0.02 * y);
        return 30.0 + 20.0 * std::max(share(std::remainder(bent - 40.0, 80.0)), share(std::remainder(y - 40.0, 80.0)));
      },
      360, 240));
  LateralRequest request;
  request.job = "grid";
  request.grid_pitch_um = 80.0;

  const StudyPage page = page_of("calibrate.lateral", request);

  expect_one_page(page);
  ASSERT_TRUE(page.map);
  EXPECT_GE(page.map->arrows.size(), 9U);
  EXPECT_THAT(page.map->arrows_title, HasSubstr("the longest"));
  StudyPage without = page_of("calibrate.lateral", request);
  without.map->arrows.clear();
  EXPECT_NE(study_pdf(without), study_pdf(page)) << "the arrows are drawn";
}

}  // namespace
}  // namespace fvd
