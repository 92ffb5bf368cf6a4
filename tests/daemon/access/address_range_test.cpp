#include "daemon/access/address_range.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

AddressBytes bytes(const char* text) { return address_bytes(text).value(); }

TEST(AddressRange, ContainsWhatSharesItsPrefix) {
  const auto net = AddressRange::parse("192.168.1.0/24").value();
  EXPECT_TRUE(net.contains(bytes("192.168.1.10")));
  EXPECT_TRUE(net.contains(bytes("::ffff:192.168.1.10"))) << "as a listener of both families sees it";
  EXPECT_FALSE(net.contains(bytes("192.168.2.10")));
  EXPECT_FALSE(net.contains(bytes("::1")));
  const auto one = AddressRange::parse("10.0.0.7").value();
  EXPECT_TRUE(one.contains(bytes("10.0.0.7")));
  EXPECT_FALSE(one.contains(bytes("10.0.0.6")));
  const auto local = AddressRange::parse("fe80::/10").value();
  EXPECT_TRUE(local.contains(bytes("fe80::1%eth0")));
  EXPECT_FALSE(local.contains(bytes("fd00::1")));
  EXPECT_FALSE(local.contains(bytes("254.128.0.1"))) << "the same bits, in another family";
  EXPECT_TRUE(AddressRange::parse("0.0.0.0/0").value().contains(bytes("1.2.3.4")));
  EXPECT_FALSE(AddressRange::parse("0.0.0.0/0").value().contains(bytes("2001:db8::1")));
  EXPECT_GT(one.prefix_bits(), net.prefix_bits());
}

TEST(AddressRange, RefusesWhatIsNoRange) {
  for (const char* text : {"", "plc", "192.168.1", "192.168.1.256", "192.168.1.0/33", "192.168.1.0/-1", "192.168.1.0/",
                           "192.168.1.0/24x", "192.168.1.10/24", "fd00::/129", "fe80::1%eth0", "/24", "1.2.3.4/8/8"}) {
    EXPECT_FALSE(AddressRange::parse(text)) << text;
  }
}

TEST(AddressRange, KnowsLoopback) {
  for (const char* text : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"}) EXPECT_TRUE(is_loopback(bytes(text)));
  for (const char* text : {"0.0.0.0", "::", "128.0.0.1", "::ffff:10.0.0.1"}) EXPECT_FALSE(is_loopback(bytes(text)));
}

}  // namespace
}  // namespace fvd
