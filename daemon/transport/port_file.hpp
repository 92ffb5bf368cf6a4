#pragma once

/// The file in which clients on this machine find the port of the server.

#include <filesystem>
#include <string>

namespace fvd {

/// Writes {"address","port","socket","pid"} whole or not at all, and makes the folder. socket: path of the unix socket.
/// Throws Error kStorageWrite.
void write_port_file(const std::filesystem::path& file, const std::string& address, int port,
                     const std::filesystem::path& socket);

/// Removes the file if this process wrote it.
void remove_port_file(const std::filesystem::path& port_file) noexcept;

}  // namespace fvd
