#include "daemon/transport/unix_socket.hpp"

#include <fstream>
#include <optional>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/expect_error.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

class AUnixSocket : public testing::Test {
 protected:
  test::ScratchDir folder_;
  const std::filesystem::path file_ = folder_ / "run/fvd.sock";
};

TEST_F(AUnixSocket, IsThereForEverybodyAndGoneAtItsEnd) {
  std::optional<UnixSocket> listening(file_);
  struct stat status {};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_TRUE(S_ISSOCK(status.st_mode));
  EXPECT_EQ(status.st_mode & 0777U, 0666U);
  EXPECT_FALSE(std::filesystem::exists(file_.string() + "~"));
  const LineClient client(file_);
  listening.reset();
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(AUnixSocket, ReplacesWhatAKilledDaemonLeftAndNoLivingOnes) {
  {
    std::filesystem::create_directories(file_.parent_path());
    const UniqueFd dead(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    file_.string().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(dead.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ASSERT_TRUE(std::filesystem::exists(file_)) << "nobody removed it";
  const UnixSocket living(file_);
  FVD_EXPECT_ERROR(kNotReady, UnixSocket{file_});
  const LineClient client(file_);
}

TEST_F(AUnixSocket, LeavesAloneWhatIsNotItsOwn) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_) << "precious";
  FVD_EXPECT_ERROR(kBadConfig, UnixSocket{file_});
  EXPECT_EQ(test::read_text(file_), "precious");
  std::filesystem::remove(file_);
  std::optional<UnixSocket> first(file_);
  std::filesystem::remove(file_);
  const UnixSocket second(file_);
  first.reset();
  EXPECT_TRUE(std::filesystem::exists(file_)) << "it is the second one's";
  FVD_EXPECT_ERROR(kBadConfig, UnixSocket{folder_ / std::string(120, 'x')});
}

TEST_F(AUnixSocket, KnowsTheProcessAtTheOtherEnd) {
  UnixSocket listening(file_);
  const UniqueFd listener(listening.take_listener());
  const LineClient client(file_);
  const UniqueFd accepted(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
  const LocalPeer peer = local_peer_of(accepted.get());
  EXPECT_EQ(peer.pid, ::getpid());
  EXPECT_EQ(peer.uid, ::geteuid());
  EXPECT_EQ(peer.groups.back(), ::getegid());
  EXPECT_EQ(local_peer_of(-1).uid, static_cast<uid_t>(-1)) << "nobody";
}

}  // namespace
}  // namespace fvd
