/// Maps of results by GET.

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/resources/job_resource.hpp"
#include "tests/daemon/resources/fake_results.hpp"
#include "tests/daemon/resources/requests.hpp"
#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::body_of;
using test::field_of;
using test::read_view;
using test::ReadView;
using test::request_of;
using Query = std::map<std::string, std::string>;

constexpr const char* kHeightPath = "/api/v1/jobs/J7/height";

class JobHeights : public testing::Test {
 protected:
  void store(const std::string& id, const Plane<float>& heights) {
    results_.add(test::stored_result(scratch_ / id, test::result_with(heights)));
  }
  ReadView view(const Query& query = {}, const std::string& path = kHeightPath) {
    ResourceAnswer answer = resource_.get(request_of(path, query));
    EXPECT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(field_of(answer, "Content-Type"), "application/octet-stream");
    return read_view(body_of(answer));
  }
  /// Of a refusal, which says why.
  std::string refusal(const Query& query, int status, const std::string& path = kHeightPath) {
    const ResourceAnswer answer = resource_.get(request_of(path, query));
    EXPECT_EQ(answer.status, status) << answer.body;
    EXPECT_EQ(field_of(answer, "Cache-Control"), "no-store");
    EXPECT_EQ(field_of(answer, "ETag"), "");
    const json body = json::parse(answer.body, nullptr, false);
    if (!body.is_object()) return "no JSON: " + answer.body;
    EXPECT_FALSE(body.value("message", "").empty());
    return body.value("error", "");
  }

  test::ScratchDir scratch_;
  FakeResults results_;
  JobResource resource_{results_};
};

TEST_F(JobHeights, GiveTheWholeMapReducedToWhatWasAskedFor) {
  const Plane<float> heights = test::rough(120, 90, 0.2);
  store("J7", heights);

  EXPECT_EQ(view().factor, 1U) << "512 by default";
  const ReadView small = view({{"max", "40"}});

  EXPECT_EQ(small.factor, 3U);
  EXPECT_EQ(small.width, 40U);
  EXPECT_EQ(small.height, 30U);
  EXPECT_EQ(small.planes, 3U);
  EXPECT_EQ(small.map_width, 120U);
  EXPECT_EQ(small.map_height, 90U);
  float lowest = 1.0F;
  for (int y = 30; y < 33; ++y) {
    for (int x = 60; x < 63; ++x) {
      if (heights.at(x, y) < lowest) lowest = heights.at(x, y);
    }
  }
  EXPECT_EQ(small.at(1, 20, 10), lowest);
}

TEST_F(JobHeights, GiveTheFilesOwnPointsOfAWindow) {
  const Plane<float> heights = test::rough(120, 90, 0.2);
  store("J7", heights);

  const ReadView piece = view({{"x", "100"}, {"y", "80"}, {"w", "20"}, {"h", "10"}});
  const ReadView rest = view({{"x", "119"}, {"y", "3"}});

  ASSERT_EQ(piece.values.size(), 200U);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      const float point = heights.at(100 + x, 80 + y);
      EXPECT_TRUE(std::isnan(point) ? std::isnan(piece.at(0, x, y)) : point == piece.at(0, x, y));
    }
  }
  EXPECT_EQ(rest.width, 1U);
  EXPECT_EQ(rest.height, 87U);
}

TEST_F(JobHeights, GiveTheOtherMaps) {
  const Plane<float> heights = test::rough(16, 16, 0.3);
  store("J7", heights);

  const ReadView sigma = view({{"kind", "sigma"}});
  const ReadView texture = view({{"kind", "texture"}});
  const ReadView reasons = view({{"kind", "reason"}});

  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const bool hole = std::isnan(heights.at(x, y));
      EXPECT_EQ(std::isnan(sigma.at(0, x, y)), hole);
      EXPECT_EQ(texture.at(0, x, y), static_cast<float>(x + 10 * y));
      EXPECT_EQ(reasons.at(0, x, y), hole ? static_cast<float>(mask_reason::kLowProminence) : 0.0F);
    }
  }
}

TEST_F(JobHeights, OfAMapWithoutAValidPointAreHoles) {
  store("J7", Plane<float>(30, 20, test::kNoPoint));

  const ReadView whole = view();
  const ReadView small = view({{"max", "5"}});

  EXPECT_EQ(whole.values.size(), 600U);
  EXPECT_EQ(small.values.size(), 3U * 5U * 4U);
  EXPECT_THAT(whole.values, testing::Each(testing::IsNan<float>()));
  EXPECT_THAT(small.values, testing::Each(testing::IsNan<float>()));
}

TEST_F(JobHeights, OfAnEvaluationAreThoseOfItsJob) {
  store("J7", test::letter_f(16, 16));
  std::filesystem::create_directory(scratch_ / "J7-e1");
  StoredJob evaluation;
  evaluation.status.job_id = "J7-e1";
  evaluation.result_dir = scratch_ / "J7-e1";
  evaluation.result_json = R"({"source": {"job_id": "J7"}})";
  results_.add(evaluation);

  EXPECT_EQ(view({}, "/api/v1/jobs/J7-e1/height").values, view().values);
}

TEST_F(JobHeights, OfALargeViewAreMadeWhileTheyAreSent) {
  store("J7", test::rough(1100, 1000, 0.1));
  ResourceAnswer answer = resource_.get(request_of(kHeightPath, {{"max", "2048"}}));

  ASSERT_TRUE(answer.source);
  EXPECT_EQ(answer.source_bytes, 32U + 4U * 1100U * 1000U);
  const ReadView whole = read_view(body_of(answer));
  const ReadView piece = view({{"x", "900"}, {"y", "700"}, {"w", "200"}, {"h", "300"}});
  EXPECT_EQ(piece.factor, 1U);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 200; ++x) {
      const float point = whole.at(0, 900 + x, 700 + y);
      EXPECT_TRUE(std::isnan(point) ? std::isnan(piece.at(0, x, y)) : point == piece.at(0, x, y));
    }
  }
}

TEST_F(JobHeights, AreNeverLargerThanTwoThousandPointsASide) {
  store("J7", Plane<float>(5000, 3, 1e-6F));

  const ReadView wide = view({{"max", "1000000000"}});

  EXPECT_EQ(wide.factor, 3U);
  EXPECT_EQ(wide.width, 1667U);
}

TEST_F(JobHeights, AreKeptForEverByTheirTag) {
  store("J7", test::rough(16, 16, 0.3));
  store("J8", test::rough(16, 16, 0.3));
  const auto tag = [&](const Query& query, const std::string& path = kHeightPath) {
    const ResourceAnswer answer = resource_.get(request_of(path, query));
    EXPECT_EQ(field_of(answer, "Cache-Control"), "private, max-age=31536000, immutable");
    return field_of(answer, "ETag");
  };
  const std::string whole = tag({});

  EXPECT_THAT(whole, testing::MatchesRegex("\"[!#-~]+\"")) << "strong";
  EXPECT_EQ(tag({}), whole);
  EXPECT_EQ(tag({{"x", "0"}, {"y", "0"}, {"w", "16"}, {"h", "16"}, {"max", "512"}, {"kind", "height"}}), whole)
      << "the same view";
  for (const Query& query : {Query{{"x", "1"}}, Query{{"y", "1"}}, Query{{"w", "5"}}, Query{{"h", "5"}},
                             Query{{"max", "8"}}, Query{{"kind", "sigma"}}}) {
    EXPECT_NE(tag(query), whole) << query.begin()->first;
  }
  EXPECT_NE(tag({}, "/api/v1/jobs/J8/height"), whole);
}

TEST_F(JobHeights, ThatAreKnownAreNotSentAgain) {
  store("J7", test::rough(16, 16, 0.3));
  ResourceRequest request = request_of(kHeightPath);
  const std::string tag = field_of(resource_.get(request), "ETag");
  request.if_none_match = R"("other", W/)" + tag;

  const ResourceAnswer known = resource_.get(request);

  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(field_of(known, "ETag"), tag);
  EXPECT_EQ(field_of(known, "Cache-Control"), "private, max-age=31536000, immutable");
  EXPECT_TRUE(known.body.empty());
  EXPECT_FALSE(known.source);
  request.if_none_match = R"("other")";
  EXPECT_EQ(resource_.get(request).status, 200);
}

TEST_F(JobHeights, AnswerHeadLikeGet) {
  store("J7", test::rough(16, 16, 0.3));
  ResourceRequest request = request_of(kHeightPath, {{"max", "8"}});
  const ResourceAnswer got = resource_.get(request);
  request.is_head = true;
  const ResourceAnswer head = resource_.get(request);

  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.fields, got.fields);
  EXPECT_EQ(head.source ? head.source_bytes : head.body.size(), got.body.size());
}

TEST_F(JobHeights, AreTheSameWhateverVersionTheAddressNames) {
  store("J7", test::rough(16, 16, 0.3));
  const ResourceAnswer plain = resource_.get(request_of(kHeightPath));
  for (const char* version : {"1", "", "-1", "two"}) {
    const ResourceAnswer answer = resource_.get(request_of(kHeightPath, {{"v", version}}));
    EXPECT_EQ(answer.status, 200) << version;
    EXPECT_EQ(answer.fields, plain.fields);
    EXPECT_EQ(answer.body, plain.body);
  }
}

TEST_F(JobHeights, AreRefusedWhereTheQueryIsWrong) {
  store("J7", test::rough(16, 16, 0.3));
  for (const Query& query : {Query{{"kind", "heights"}},
                             Query{{"kind", ""}},
                             Query{{"x", "-1"}},
                             Query{{"x", "1.5"}},
                             Query{{"x", ""}},
                             Query{{"x", "+1"}},
                             Query{{"x", " 1"}},
                             Query{{"x", "1e1"}},
                             Query{{"x", "0x1"}},
                             Query{{"w", "0"}},
                             Query{{"h", "0"}},
                             Query{{"max", "0"}},
                             Query{{"max", "-5"}},
                             Query{{"max", "nan"}},
                             Query{{"y", "99999999999999999999"}},
                             Query{{"y", "2147483648"}},
                             Query{{"w", "1\r\nX: y"}},
                             Query{{"w", std::string("1\0", 2)}},
                             Query{{"h", std::string(10240, '1')}},
                             Query{{"most", "5"}},
                             Query{{"", ""}},
                             Query{{std::string(10240, 'k'), "1"}}}) {
    EXPECT_EQ(refusal(query, 400), "bad_query")
        << query.begin()->first.substr(0, 20) << "=" << query.begin()->second.substr(0, 20);
  }
  for (const Query& query : {Query{{"x", "16"}}, Query{{"y", "16"}}, Query{{"w", "17"}}, Query{{"h", "17"}},
                             Query{{"x", "15"}, {"w", "2"}}, Query{{"x", "1000000000"}, {"w", "1000000000"}}}) {
    EXPECT_EQ(refusal(query, 400), "outside");
  }
}

TEST_F(JobHeights, AreRefusedWhereThereAreNone) {
  ResultData bare = test::result_with(test::rough(16, 16, 0.3));
  bare.exports = {"x3p"};
  results_.add(test::stored_result(scratch_ / "J7", bare));
  StoredJob running;
  running.status.job_id = "J1";
  results_.add(running);

  EXPECT_EQ(refusal({{"kind", "sigma"}}, 404), "no_map");
  EXPECT_EQ(refusal({{"kind", "texture"}}, 404), "no_map");
  EXPECT_EQ(refusal({{"kind", "reason"}}, 404), "no_map");
  EXPECT_EQ(view().width, 16U);
  EXPECT_EQ(refusal({}, 404, "/api/v1/jobs/J1/height"), "no_result");
  FVD_EXPECT_ERROR(kUnknownJob, (void)resource_.get(request_of("/api/v1/jobs/J9/height")));
}

TEST_F(JobHeights, OfARemovedResultAreGone) {
  store("J7", test::rough(16, 16, 0.3));
  EXPECT_EQ(view().width, 16U);
  results_.jobs["J7"].status.removed_utc = "2026-11-30T10:00:00.000Z";
  std::filesystem::remove_all(scratch_ / "J7");

  FVD_EXPECT_ERROR(kResultRemoved, (void)resource_.get(request_of(kHeightPath)));
  results_.jobs["J7"].status.removed_utc.clear();
  EXPECT_EQ(refusal({}, 404), "no_map") << "its files are not kept open";
}

TEST_F(JobHeights, OfADamagedFileAreAnError) {
  store("J7", test::rough(64, 64, 0.3));
  store("J8", test::rough(64, 64, 0.3));
  std::filesystem::resize_file(scratch_ / "J7" / "height.tiff", 500);
  FVD_EXPECT_ERROR(kSurfaceFile, (void)resource_.get(request_of(kHeightPath)));
  EXPECT_EQ(view({}, "/api/v1/jobs/J8/height").width, 64U);

  std::filesystem::resize_file(scratch_ / "J8" / "height.tiff", 500);  // while it is open

  FVD_EXPECT_ERROR(kSurfaceFile, (void)resource_.get(request_of("/api/v1/jobs/J8/height")));
}

}  // namespace
}  // namespace fvd
