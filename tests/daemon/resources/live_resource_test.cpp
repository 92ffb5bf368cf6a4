#include "daemon/resources/live_resource.hpp"

#include <gmock/gmock.h>

#include "tests/daemon/resources/requests.hpp"
#include "tests/daemon/views/fake_pictures.hpp"

namespace fvd {
namespace {

using test::field_of;
using test::request_of;

ResourceRequest after(const std::string& number, std::chrono::milliseconds waited = std::chrono::milliseconds(0)) {
  ResourceRequest request = request_of("/api/v1/preview.jpg", {{"after", number}});
  request.waited = waited;
  return request;
}

TEST(LiveResource, SendsAPictureWithItsFacts) {
  FakePictures pictures;
  pictures.show(3);
  LiveResource resource(pictures);

  const ResourceAnswer answer = resource.get(request_of("/api/v1/preview.jpg"));

  EXPECT_EQ(answer.status, 200);
  EXPECT_FALSE(answer.again_after);
  EXPECT_EQ(field_of(answer, "Content-Type"), "image/jpeg");
  EXPECT_EQ(field_of(answer, "Cache-Control"), "no-store");
  EXPECT_EQ(field_of(answer, "X-Fvd-Seq"), "3");
  EXPECT_EQ(field_of(answer, "X-Fvd-Width-Px"), "640");
  EXPECT_EQ(field_of(answer, "X-Fvd-Height-Px"), "320");
  EXPECT_EQ(field_of(answer, "X-Fvd-Z-Um"), "12.5");
  EXPECT_EQ(field_of(answer, "X-Fvd-Focus"), "8.25");
  EXPECT_EQ(field_of(answer, "X-Fvd-Saturated-Fraction"), "0.125");
  EXPECT_THAT(answer.body, testing::StartsWith("\xFF\xD8\xFF"));
  EXPECT_TRUE(resource.get(after("2")).body == answer.body);
}

TEST(LiveResource, WaitsForAnotherPicture) {
  FakePictures pictures;
  LiveResource resource(pictures);

  const ResourceAnswer none = resource.get(after("0"));
  pictures.show(3);
  const ResourceAnswer same = resource.get(after("3", std::chrono::milliseconds(4999)));
  const ResourceAnswer late = resource.get(after("3", std::chrono::milliseconds(5000)));
  pictures.show(4);
  const ResourceAnswer next = resource.get(after("3", std::chrono::milliseconds(9000)));

  ASSERT_TRUE(none.again_after);
  EXPECT_GT(*none.again_after, std::chrono::milliseconds(0));
  EXPECT_LE(*none.again_after, std::chrono::milliseconds(100));
  EXPECT_TRUE(same.again_after);
  EXPECT_FALSE(late.again_after);
  EXPECT_EQ(late.status, 204);
  EXPECT_TRUE(late.body.empty());
  EXPECT_EQ(field_of(late, "X-Fvd-Seq"), "");
  EXPECT_EQ(next.status, 200);
  EXPECT_EQ(field_of(next, "X-Fvd-Seq"), "4");
  EXPECT_EQ(pictures.looks, 4) << "whoever waits counts as a viewer";
}

TEST(LiveResource, LeavesOutAHeightThatIsNotKnown) {
  FakePictures pictures;
  auto picture = std::make_shared<PreviewPicture>();
  picture->seq = 1;
  picture->pixels = Plane<std::uint8_t>(1, 1, 255);
  picture->z_um = std::nan("");
  pictures.newest = picture;
  LiveResource resource(pictures);

  const ResourceAnswer answer = resource.get(after("0"));

  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(field_of(answer, "X-Fvd-Z-Um"), "");
}

TEST(LiveResource, RefusesWhatIsNoNumber) {
  FakePictures pictures;
  pictures.show(3);
  LiveResource resource(pictures);
  for (const std::string& number : {std::string(), std::string("x"), std::string("-1"), std::string("1.5"),
                                    std::string("+1"), std::string(" 1"), std::string("99999999999999999999"),
                                    std::string("1\r\nX: y"), std::string("1\0", 2), std::string(10240, '9')}) {
    const ResourceAnswer answer = resource.get(after(number));
    EXPECT_EQ(answer.status, 400) << number.substr(0, 20);
    EXPECT_FALSE(answer.again_after);
  }
  EXPECT_EQ(resource.get(request_of("/api/v1/preview.jpg", {{"before", "1"}})).status, 400);
  EXPECT_EQ(resource.get(request_of("/api/v1/preview.jpg/x")).status, 404);
  EXPECT_EQ(resource.get(after("18446744073709551615")).status, 200) << "of a daemon that was started anew";
}

}  // namespace
}  // namespace fvd
