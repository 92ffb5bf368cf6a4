#include "sim/base/pseudo_terminal.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>

#include "core/base/error.hpp"

namespace fvd::sim {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::kBadConfig, "the simulated serial line: " + what + ": " + std::strerror(errno));
}

int open_master() {
  const int fd = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) refuse("no pseudo-terminal");
  if (::grantpt(fd) == 0 && ::unlockpt(fd) == 0) return fd;
  const int reason = errno;
  ::close(fd);
  errno = reason;
  refuse("no access to the pseudo-terminal");
}

std::filesystem::path slave_of(int master) {
  std::array<char, 128> name{};
  if (::ptsname_r(master, name.data(), name.size()) != 0) refuse("the pseudo-terminal has no name");
  return name.data();
}

/// Raw, as a serial port without a line discipline.
int open_slave(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) refuse("cannot open " + path.string());
  termios settings{};
  ::tcgetattr(fd, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(fd, TCSANOW, &settings);
  return fd;
}

void make_link(const std::filesystem::path& link, const std::filesystem::path& target) {
  if (link.empty()) return;
  std::error_code error;
  if (std::filesystem::is_symlink(link, error)) std::filesystem::remove(link, error);
  std::filesystem::create_symlink(target, link, error);
  if (!error) return;
  errno = error.value();
  refuse("cannot make the link " + link.string());
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::filesystem::path& link)
    : master_(open_master()), slave_path_(slave_of(master_.get())), slave_(open_slave(slave_path_)), link_(link) {
  make_link(link_, slave_path_);
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  if (!link_.empty()) std::filesystem::remove(link_, ignored);
}

void PseudoTerminal::end_exclusive_use() const { ::ioctl(slave_.get(), TIOCNXCL); }

}  // namespace fvd::sim
