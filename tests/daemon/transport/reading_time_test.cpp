/// How long a client may take to read an answer.

#include "daemon/transport/reading_time.hpp"

#include <chrono>
#include <cstddef>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(ReadingTime, IsThatOfAPieceForEachPieceThatIsBegun) {
  constexpr std::size_t kPieceOf_bytes = std::size_t{256} << 10U;
  EXPECT_EQ(reading_time(0), std::chrono::seconds(10)) << "a header alone";
  EXPECT_EQ(reading_time(1), std::chrono::seconds(10));
  EXPECT_EQ(reading_time(kPieceOf_bytes), std::chrono::seconds(10));
  EXPECT_EQ(reading_time(kPieceOf_bytes + 1), std::chrono::seconds(20));
  EXPECT_EQ(reading_time(16 * kPieceOf_bytes), std::chrono::seconds(160)) << "the largest map that is sent whole";
}

}  // namespace
}  // namespace fvd
