#include "drivers/common/drive_lock.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <netdb.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr mode_t kEverybodysFolder = 01777;  // as /tmp
constexpr const char* kOwnParent = "/tmp";   // where there is no /run/lock
constexpr mode_t kEverybodysFile = 0666;     // each holder writes its name into it, whoever made it

/// Of several names of a host the lock must be the same, in whichever order its addresses come: the first of those of
/// version 4, or of the others where it has none.
std::string numeric_address(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int failure = ::getaddrinfo(host.c_str(), nullptr, &hints, &found); failure != 0) {
    throw Error(ErrorCode::kStageDisconnected,
                "the drive's host '" + host + "' has no address: " + ::gai_strerror(failure) + "; see /stage/address");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  std::vector<std::pair<bool, std::string>> addresses;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (::getnameinfo(one->ai_addr, one->ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0)
      continue;
    addresses.emplace_back(one->ai_family != AF_INET, text.data());
  }
  return addresses.empty() ? host : std::min_element(addresses.begin(), addresses.end())->second;
}

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
}

/// What no file name may hold becomes its number, so that two drives never share a name.
std::string as_file_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    if (is_plain(c)) {
      name += c;
    } else {
      name += '_' + std::to_string(static_cast<unsigned char>(c)) + '_';
    }
  }
  return name;
}

/// "process 1234 (fvd)", as the holder wrote it. It may not have done so yet.
std::string holder_of(int file) {
  std::array<char, 64> text{};
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  std::string holder(text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  holder = holder.substr(0, holder.find('\n'));
  const bool is_readable = std::all_of(holder.begin(), holder.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return holder.empty() || !is_readable ? "another program" : holder;
}

void sign(int file) {
  const std::string holder = "process " + std::to_string(::getpid()) + " (" + ::program_invocation_short_name + ")\n";
  if (::ftruncate(file, 0) != 0) return;  // who is refused is told of "another program"
  [[maybe_unused]] const ssize_t written = ::pwrite(file, holder.data(), holder.size(), 0);
}

/// A file that is there is opened without O_CREAT, which the kernel refuses in everybody's folder for files of others.
/// One that may not be written to, as another user left it, is locked all the same, and keeps its signature.
int open_lock(const fs::path& path) {
  constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW;
  int file = ::open(path.c_str(), kFlags | O_RDWR);
  if (file < 0 && errno == EACCES) file = ::open(path.c_str(), kFlags | O_RDONLY);
  if (file >= 0 || errno != ENOENT) return file;
  file = ::open(path.c_str(), kFlags | O_RDWR | O_CREAT | O_EXCL, kEverybodysFile);
  if (file < 0) return errno == EEXIST ? open_lock(path) : file;
  (void)::fchmod(file, kEverybodysFile);  // whatever the umask took away
  return file;
}

bool is_at(int file, const fs::path& path) {
  struct stat opened {};
  struct stat there {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &there) == 0 && opened.st_ino == there.st_ino &&
         opened.st_dev == there.st_dev;
}

}  // namespace

fs::path drive_lock_folder() {
  std::error_code error;
  return fs::is_directory("/run/lock", error) ? fs::path("/run/lock/fvd") : fs::path(kOwnParent) / "fvd-lock";
}

std::string drive_lock_name(const StageConfig& config) {
  std::string drive;
  if (config.transport == "tcp") {
    drive = numeric_address(config.address) + "-" + std::to_string(config.port);
  } else {
    std::error_code error;
    const fs::path real = fs::canonical(config.serial_device, error);
    drive = error ? config.serial_device : real.string();
  }
  const bool has_units = config.driver == "modbus" && config.transport == "tcp";
  if (has_units) drive += "-unit-" + std::to_string(config.unit);
  if (config.driver == "gcs" && config.transport == "tcp") drive += "-axis-" + config.gcs_axis;
  return as_file_name(drive) + ".lock";
}

DriveLock::DriveLock(const StageConfig& config) {
  const fs::path folder = drive_lock_folder();
  if (::mkdir(folder.c_str(), kEverybodysFolder) == 0) (void)::chmod(folder.c_str(), kEverybodysFolder);
  if (folder.parent_path() == kOwnParent) {
    spdlog::warn("without /run/lock the drive's lock is in {}, which a service with a /tmp of its own does not see",
                 folder.string());
  }
  path_ = folder / drive_lock_name(config);
  // A file that its holder has just taken away locks nothing: the next one is taken.
  do {
    if (file_ >= 0) ::close(file_);
    file_ = open_lock(path_);
    if (file_ < 0) refuse_file();
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) refuse_drive(errno);
  } while (!is_at(file_, path_));
  sign(file_);
}

DriveLock::~DriveLock() {
  (void)::unlink(path_.c_str());  // where it is another user's it stays, and is signed by the next holder
  ::close(file_);
}

void DriveLock::refuse_file() const {
  throw Error(ErrorCode::kBadConfig, "the drive's lock file " + path_.string() + " cannot be opened: " +
                                         std::strerror(errno) + "; without it two programs might move one axis: give " +
                                         drive_lock_folder().string() + " the mode 1777, and the file 0666");
}

void DriveLock::refuse_drive(int failure) const {
  const std::string holder =
      failure == EWOULDBLOCK ? holder_of(file_) : std::string("nobody: ") + std::strerror(failure);
  ::close(file_);
  throw Error(ErrorCode::kStageTaken, "the drive is in use by " + holder + ", which holds " + path_.string() +
                                          "; nothing was sent to it: end that program first");
}

std::shared_ptr<const DriveLock> drive_lock_of(const StageConfig& config) {
  return config.lock ? config.lock : std::make_shared<const DriveLock>(config);
}

}  // namespace fvd
