#include "daemon/events/event_ring.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

constexpr std::size_t kPlenty = 1U << 20U;

TEST(EventText, IsOneEventOfAStream) {
  EXPECT_EQ(event_text("17-3", "state", "{}"), "id: 17-3\nevent: state\ndata: {}\n\n");
  EXPECT_EQ(event_text("", "ping", "{}"), "event: ping\ndata: {}\n\n");
}

TEST(EventRing, GivesWhatCameAfterAPlace) {
  EventRing ring(17);
  EXPECT_EQ(ring.newest(), 0U);
  EXPECT_EQ(ring.after(0, kPlenty).text, "");
  ring.add("a", "1");
  ring.add("b", "2");
  EXPECT_EQ(ring.newest(), 2U);
  const auto all = ring.after(0, kPlenty);
  EXPECT_EQ(all.text, "id: 17-1\nevent: a\ndata: 1\n\nid: 17-2\nevent: b\ndata: 2\n\n");
  EXPECT_EQ(all.last, 2U);
  EXPECT_EQ(ring.after(1, kPlenty).text, "id: 17-2\nevent: b\ndata: 2\n\n");
  EXPECT_EQ(ring.after(2, kPlenty).text, "");
  EXPECT_EQ(ring.after(2, kPlenty).last, 2U);
}

TEST(EventRing, GivesNoMoreAtOnceThanIsWanted) {
  EventRing ring(17);
  for (int i = 0; i < 10; ++i) ring.add("a", "0123456789");
  const std::size_t one = ring.after(9, kPlenty).text.size();
  EXPECT_EQ(ring.after(0, 3 * one).last, 3U);
  EXPECT_EQ(ring.after(0, 1).last, 1U) << "one in any case, or nobody would get on";
  EXPECT_EQ(ring.after(0, 0).last, 1U);
}

TEST(EventRing, FindsPlacesByTheirIds) {
  EventRing ring(17, {.events = 3});
  EXPECT_EQ(ring.place_of("17-0"), 0U) << "before the first";
  for (int i = 0; i < 5; ++i) ring.add("a", "x");
  EXPECT_EQ(ring.place_of("17-5"), 5U);
  EXPECT_EQ(ring.place_of("17-2"), 2U) << "the next one is the oldest";
  EXPECT_FALSE(ring.place_of("17-1")) << "an event after it is gone";
  EXPECT_FALSE(ring.place_of("17-0"));
  EXPECT_FALSE(ring.place_of("17-6")) << "not told yet";
  EXPECT_FALSE(ring.place_of("16-5")) << "of before a restart";
  EXPECT_FALSE(ring.place_of("18-5"));
}

TEST(EventRing, TakesNoOtherTextForAnId) {
  EventRing ring(17);
  for (int i = 0; i < 5; ++i) ring.add("a", "x");
  for (const char* text :
       {"", "-", "5", "17", "17-", "-5", "17--5", "17-05", "17-5 ", " 17-5", "17-5x", "017-5", "17-+5",
        "17-18446744073709551616", "17-99999999999999999999999", "a-5", "17-5-5", "17\n-5"}) {
    EXPECT_FALSE(ring.place_of(text)) << text;
  }
}

TEST(EventRing, KnowsWhatIsGone) {
  EventRing ring(17, {.events = 3});
  EXPECT_EQ(ring.missing_after(0), 0U);
  for (int i = 0; i < 5; ++i) ring.add("a", "x");
  EXPECT_EQ(ring.missing_after(0), 2U);
  EXPECT_EQ(ring.missing_after(1), 1U);
  EXPECT_EQ(ring.missing_after(2), 0U);
  EXPECT_EQ(ring.missing_after(5), 0U);
}

TEST(EventRing, KeepsNoMoreBytesThanItMay) {
  EventRing ring(17, {.events = 100, .bytes = 1000});
  for (int i = 0; i < 50; ++i) ring.add("a", std::string(100, 'x'));
  EXPECT_GT(ring.missing_after(0), 40U);
  EXPECT_LE(ring.after(ring.missing_after(0), kPlenty).text.size(), 1000U);
  ring.add("a", std::string(5000, 'y'));
  EXPECT_EQ(ring.missing_after(0), 50U) << "the newest stays";
  EXPECT_GT(ring.after(50, 10).text.size(), 5000U);
}

TEST(EventRing, HasTenThousandByItself) {
  EventRing ring(1);
  for (int i = 0; i < 10'005; ++i) ring.add("a", "x");
  EXPECT_EQ(ring.missing_after(0), 5U);
}

}  // namespace
}  // namespace fvd
