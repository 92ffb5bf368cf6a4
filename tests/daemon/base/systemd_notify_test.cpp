#include "daemon/base/systemd_notify.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

/// The socket on which systemd listens to its services.
class AServiceManager : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string path = (folder_.path() / "notify").string();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    ASSERT_LT(path.size(), sizeof address.sun_path);
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(socket_, 0);
    ASSERT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const timeval deadline{.tv_sec = 2, .tv_usec = 0};
    ASSERT_EQ(::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &deadline, sizeof deadline), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("NOTIFY_SOCKET");
    if (socket_ >= 0) ::close(socket_);
  }
  std::string heard() {
    std::array<char, 1024> text{};
    const auto size = ::recv(socket_, text.data(), text.size(), 0);
    return size < 0 ? "nothing" : std::string(text.data(), static_cast<std::size_t>(size));
  }
  test::ScratchDir folder_;
  int socket_ = -1;
};

TEST_F(AServiceManager, HearsThatTheServiceIsReady) {
  notify_ready("listening on 127.0.0.1:7411");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=listening on 127.0.0.1:7411");
}

TEST_F(AServiceManager, HearsTheStatusOnOneLine) {
  notify_status("job failed:\nWATCHDOG=trigger");
  EXPECT_EQ(heard(), "STATUS=job failed: WATCHDOG=trigger") << "a message must not become an assignment";
}

TEST_F(AServiceManager, HearsThatTheServiceStops) {
  notify_stopping();
  EXPECT_THAT(heard(), ::testing::StartsWith("STOPPING=1\n"));
}

TEST_F(AServiceManager, HearsNothingOfAServiceThatItDidNotStart) {
  notify_status("started");
  ASSERT_EQ(heard(), "STATUS=started") << "the socket hears";
  ::unsetenv("NOTIFY_SOCKET");
  notify_ready("x");
  notify_status("x");
  notify_stopping();
  char byte = 0;
  EXPECT_EQ(::recv(socket_, &byte, 1, MSG_DONTWAIT), -1);
  EXPECT_TRUE(errno == EAGAIN || errno == EWOULDBLOCK) << std::strerror(errno);
}

}  // namespace
}  // namespace fvd
