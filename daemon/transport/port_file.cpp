#include "daemon/transport/port_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

void write_port_file(const std::filesystem::path& port_file, const std::string& address, int port,
                     const std::filesystem::path& socket) {
  std::error_code error;
  std::filesystem::create_directories(port_file.parent_path(), error);
  const auto temporary = port_file.string() + ".tmp";
  errno = 0;
  std::ofstream out(temporary);
  out << "{\"address\": \"" << address << "\", \"port\": " << port
      << ", \"socket\": " << nlohmann::json(socket.string()) << ", \"pid\": " << ::getpid() << "}\n";
  out.close();
  if (!out || ::rename(temporary.c_str(), port_file.c_str()) != 0) {
    throw Error(ErrorCode::kStorageWrite,
                "cannot write " + port_file.string() + ": " + std::strerror(errno) + "; see /paths/runtime_dir");
  }
}

void remove_port_file(const std::filesystem::path& port_file) noexcept {
  std::ifstream in(port_file);
  std::string text;
  // Another fvd that was given the same folder may have put its own there meanwhile.
  if (!std::getline(in, text) || text.find("\"pid\": " + std::to_string(::getpid()) + "}") == std::string::npos) return;
  std::error_code ignored;
  std::filesystem::remove(port_file, ignored);
}

}  // namespace fvd
