#include "drivers/common/network_address.hpp"

#include <gmock/gmock.h>

namespace fvd {
namespace {

using ::testing::HasSubstr;

TEST(NetworkAddress, OfADeviceIsThatOfOneMachineOrAName) {
  for (const char* address : {"192.168.10.20", "127.0.0.1", "drive", "drive.local", "fe80::1", "12345678",
                              "00:01:0d:c0:00:01", "Vendor-Model-1.2", ""}) {
    EXPECT_EQ(why_no_device(address), "") << address;
  }
  EXPECT_THAT(why_no_device("0.0.0.0"), HasSubstr("stands for no machine"));
  EXPECT_THAT(why_no_device("255.255.255.255"), HasSubstr("stands for many machines"));
  EXPECT_THAT(why_no_device("239.1.2.3"), HasSubstr("stands for many machines"));
  for (const char* address : {"192.168.10.256", "192.168.10", "1.2.3.4.5", "1.2.3.", ".."}) {
    EXPECT_THAT(why_no_device(address), HasSubstr("four numbers within 0..255")) << address;
  }
}

TEST(NetworkAddress, ToListenOnIsNumericAndNotThatOfMany) {
  for (const char* address : {"127.0.0.1", "0.0.0.0", "192.168.10.1", "::", "::1"}) {
    EXPECT_EQ(why_no_listener(address), "") << address;
  }
  for (const char* address : {"localhost", "", "127.0.0.1:80", "127.0.0.300"}) {
    EXPECT_THAT(why_no_listener(address), HasSubstr("no numeric address")) << address;
  }
  for (const char* address : {"255.255.255.255", "224.0.0.1", "ff02::1"}) {
    EXPECT_THAT(why_no_listener(address), HasSubstr("stands for many machines")) << address;
  }
}

}  // namespace
}  // namespace fvd
