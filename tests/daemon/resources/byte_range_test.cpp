#include "daemon/resources/byte_range.hpp"

#include <string>

#include <gtest/gtest.h>

namespace fvd {
namespace {

using Found = std::variant<NoRange, ByteRange, RangeBeyond>;

TEST(ByteRange, IsReadInItsThreeForms) {
  EXPECT_EQ(byte_range("bytes=0-0", 100), Found(ByteRange{0, 0}));
  EXPECT_EQ(byte_range("bytes=10-19", 100), Found(ByteRange{10, 19}));
  EXPECT_EQ(byte_range("bytes=10-19", 15), Found(ByteRange{10, 14}));
  EXPECT_EQ(byte_range("bytes=99-", 100), Found(ByteRange{99, 99}));
  EXPECT_EQ(byte_range("bytes=0-", 100), Found(ByteRange{0, 99}));
  EXPECT_EQ(byte_range("bytes=-1", 100), Found(ByteRange{99, 99}));
  EXPECT_EQ(byte_range("bytes=-1000", 100), Found(ByteRange{0, 99}));
  EXPECT_EQ(byte_range("Bytes = 1-2 ", 100), Found(ByteRange{1, 2}));
  EXPECT_EQ(byte_range("bytes=00000000000000000000000000001-2", 100), Found(ByteRange{1, 2}));
  EXPECT_EQ((ByteRange{10, 19}.bytes()), 10U);
}

TEST(ByteRange, MayLieBeyondTheEnd) {
  EXPECT_EQ(byte_range("bytes=100-", 100), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=100-200", 100), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=-0", 100), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=0-", 0), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=-5", 0), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=99999999999999999999999999999-", 100), Found(RangeBeyond{}));
  EXPECT_EQ(byte_range("bytes=0-99999999999999999999999999999", 100), Found(ByteRange{0, 99}));
  EXPECT_EQ(byte_range("bytes=-99999999999999999999999999999", 100), Found(ByteRange{0, 99}));
}

TEST(ByteRange, IsNoneWhereItCannotBeRead) {
  for (const std::string range : {"",
                                  "bytes",
                                  "bytes=",
                                  "bytes=-",
                                  "bytes=a-b",
                                  "bytes=1",
                                  "bytes=2-1",
                                  "bytes=1-2,3-4",
                                  "bytes=1-2-3",
                                  "bytes=--1",
                                  "bytes=+1-2",
                                  "bytes=1 - 2",
                                  "bytes=0x1-2",
                                  "lines=1-2",
                                  "byte=1-2",
                                  "=1-2",
                                  "bytes 1-2",
                                  "bytes=1-2\r\nX: y",
                                  "bytes=1-\n",
                                  "bytes=1.5-2",
                                  "bytes=-1-"}) {
    EXPECT_EQ(byte_range(range, 100), Found(NoRange{})) << range;
  }
  EXPECT_EQ(byte_range(std::string("bytes=1-2\0", 10), 100), Found(NoRange{}));
  EXPECT_EQ(byte_range("bytes=" + std::string(10240, '-'), 100), Found(NoRange{}));
  EXPECT_EQ(byte_range(std::string(10240, '='), 100), Found(NoRange{}));
}

}  // namespace
}  // namespace fvd
