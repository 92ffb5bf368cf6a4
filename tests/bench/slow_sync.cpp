/// A disk that takes its time, to be preloaded: fsync and fdatasync last FVD_SLOW_SYNC_MS longer.

#include <cerrno>
#include <cstdlib>
#include <ctime>

#include <sys/syscall.h>
#include <unistd.h>

namespace {

void pause_for_the_disk() {
  const char* const text = std::getenv("FVD_SLOW_SYNC_MS");
  const long ms = text != nullptr ? std::atol(text) : 0;
  timespec left{ms / 1000, ms % 1000 * 1000000L};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

}  // namespace

extern "C" int fsync(int fd) {
  pause_for_the_disk();
  return static_cast<int>(::syscall(SYS_fsync, fd));
}

extern "C" int fdatasync(int fd) {
  pause_for_the_disk();
  return static_cast<int>(::syscall(SYS_fdatasync, fd));
}
