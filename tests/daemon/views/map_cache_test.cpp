#include "daemon/views/map_cache.hpp"

#include <chrono>

#include "tests/daemon/views/made_maps.hpp"

namespace fvd {
namespace {

TEST(MapCache, KeepsTheResultsThatWereLookedAtLast) {
  MapCache cache(MapCache::Limits{.results = 2});
  const auto first = cache.of("A", "/r/A");
  const auto second = cache.of("B", "/r/B");

  EXPECT_EQ(cache.of("A", "/r/A"), first);
  (void)cache.of("C", "/r/C");  // in place of B

  EXPECT_EQ(cache.size(), 2U);
  EXPECT_EQ(cache.of("A", "/r/A"), first);
  EXPECT_NE(cache.of("B", "/r/B"), second);
  EXPECT_EQ(second->folder(), "/r/B") << "who had it has it still";
}

TEST(MapCache, KeepsNoMoreInMemoryThanItMay) {
  const test::ScratchDir scratch;
  const auto opened = [&](MapCache& cache, const std::string& id) {
    if (!std::filesystem::exists(scratch / id)) write_result(scratch / id, test::result_with(test::rough(50, 40, 0.0)));
    const auto maps = cache.of(id, scratch / id);
    EXPECT_TRUE(maps->find(MapKind::kReason));  // 4000 bytes
    return maps;
  };
  MapCache cache(MapCache::Limits{.results = 4, .bytes = 9000});

  for (const char* id : {"A", "B", "C", "D"}) (void)opened(cache, id);
  (void)cache.of("E", scratch / "E");
  EXPECT_LE(cache.size(), 3U) << "two with their maps, and the new one";

  MapCache small(MapCache::Limits{.results = 4, .bytes = 3999});
  const auto once = opened(small, "A");
  EXPECT_NE(opened(small, "A"), once) << "one that is too large is not kept";
}

TEST(MapCache, ForgetsAResultThatIsGone) {
  MapCache cache;
  const auto maps = cache.of("A", "/r/A");

  cache.forget("B");
  EXPECT_EQ(cache.of("A", "/r/A"), maps);
  cache.forget("A");
  EXPECT_EQ(cache.size(), 0U);
}

TEST(MapCache, LetsGoOfWhatNobodyLooksAt) {
  MapCache cache;
  const HostTime begin = HostClock::now();
  const auto first = cache.of("A", "/r/A", begin);
  (void)cache.of("B", "/r/B", begin);
  (void)cache.of("A", "/r/A", begin + std::chrono::seconds(30));

  cache.drop_unused(begin + MapCache::kLongestUnused);
  EXPECT_EQ(cache.size(), 2U);
  cache.drop_unused(begin + MapCache::kLongestUnused + std::chrono::milliseconds(1));
  EXPECT_EQ(cache.size(), 1U);
  EXPECT_EQ(cache.of("A", "/r/A", begin + std::chrono::seconds(89)), first) << "it was looked at since";
  cache.drop_unused(begin + std::chrono::seconds(150));
  EXPECT_EQ(cache.size(), 0U);
  EXPECT_EQ(first->folder(), "/r/A") << "who had it has it still";
  cache.drop_unused(begin + std::chrono::hours(1));
}

}  // namespace
}  // namespace fvd
