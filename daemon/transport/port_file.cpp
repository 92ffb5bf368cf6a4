#include "daemon/transport/port_file.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/replace_file.hpp"

namespace fvd {

void write_port_file(const std::filesystem::path& port_file, const std::string& address, int port,
                     const std::filesystem::path& socket) {
  std::ostringstream text;
  text << "{\"address\": \"" << address << "\", \"port\": " << port
       << ", \"socket\": " << nlohmann::json(socket.string()) << ", \"pid\": " << ::getpid() << "}\n";
  try {
    (void)make_directories(port_file.parent_path());
    replace_file(port_file, text.str());
  } catch (const Error& failure) {
    throw Error(failure.code(), std::string(failure.what()) + "; see /paths/runtime_dir");
  }
}

void remove_port_file(const std::filesystem::path& port_file) noexcept {
  std::ifstream in(port_file);
  std::string text;
  // Another fvd that was given the same folder may have put its own there meanwhile.
  if (!std::getline(in, text) || text.find("\"pid\": " + std::to_string(::getpid()) + "}") == std::string::npos) return;
  file_calls().unlink(port_file);
}

}  // namespace fvd
