#pragma once

/// A simulated GCS controller at the end of a line: TCP on the loopback, or a pseudo-terminal.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "sim/gcs/gcs_controller.hpp"

namespace fvd::sim {

struct GcsServerOptions {
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0 = any free port
  /// Instead of TCP a pseudo-terminal linked here; empty link = none, the terminal itself.
  std::optional<std::filesystem::path> terminal_link{};
};

/// One client at a time on TCP, as on the real controllers. Owns one thread.
class GcsServer {
 public:
  /// Serves. Throws Error kBadConfig if the address cannot be bound. The controller outlives the server.
  GcsServer(GcsController& controller, const GcsServerOptions& options);
  ~GcsServer();
  GcsServer(const GcsServer&) = delete;
  GcsServer& operator=(const GcsServer&) = delete;

  [[nodiscard]] int port() const noexcept;                ///< of TCP
  [[nodiscard]] std::string device() const;               ///< path of the serial line; empty on TCP
  [[nodiscard]] std::uint64_t requests() const noexcept;  ///< chunks of bytes received

  // Faults. context: any thread.
  void set_mute(bool mute);      ///< takes bytes, executes nothing, answers nothing
  void lose_answers(int count);  ///< the next `count` chunks that would be answered are executed and not answered

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd::sim
