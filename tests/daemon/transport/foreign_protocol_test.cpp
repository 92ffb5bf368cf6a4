#include "daemon/transport/foreign_protocol.hpp"

#include <string>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(ForeignProtocol, KnowsHttpRequestsOfEveryMethod) {
  for (const char* method :
       {"GET", "HEAD", "POST", "PUT", "DELETE", "CONNECT", "OPTIONS", "TRACE", "PATCH", "PRI", "post", "MADE-UP"}) {
    EXPECT_TRUE(begins_foreign_protocol(std::string(method) + " / HTTP/1.1")) << method;
    EXPECT_TRUE(begins_foreign_protocol(" \t" + std::string(method) + " * HTTP/2.0")) << method;
  }
  EXPECT_TRUE(begins_foreign_protocol("GET /")) << "HTTP 0.9";
  EXPECT_TRUE(begins_foreign_protocol("POST\t/")) << "as lenient servers read it";
}

TEST(ForeignProtocol, KnowsTls) { EXPECT_TRUE(begins_foreign_protocol("\x16\x03\x01\x02")); }

TEST(ForeignProtocol, LetsJsonAndMereNonsensePass) {
  for (const char* line : {"", " ", "{}", "[1]", "1", "null", "true", "\"POST / HTTP/1.1\"", "POST", "GETTING on",
                           R"({"jsonrpc":"2.0","id":1,"method":"system.ping","params":{"t":"GET / HTTP/1.1"}})",
                           R"( ["GET / HTTP/1.1"])", "\xff\xfe"}) {
    EXPECT_FALSE(begins_foreign_protocol(line)) << line;
  }
}

}  // namespace
}  // namespace fvd
