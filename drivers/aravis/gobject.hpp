#pragma once

/// GLib objects and errors as C++ expects them.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <arv.h>

#include "core/base/error.hpp"

namespace fvd {

struct GObjectDeleter {
  template <typename Object>
  void operator()(Object* object) const {
    g_object_unref(object);
  }
};
/// Sole owner of one reference.
template <typename Object>
using GObjectPtr = std::unique_ptr<Object, GObjectDeleter>;

/// Collects what GLib logs in one domain while it lives, in place of standard error: a damaged description is some
/// three hundred messages. One object at a time.
class LogCollector {
 public:
  explicit LogCollector(const char* domain) : domain_(domain) {
    // Aravis logs by fields, which only the process' one writer sees.
    static std::once_flag once;
    std::call_once(once, [] { g_log_set_writer_func(&write, nullptr, nullptr); });
    active() = this;
  }
  ~LogCollector() { active() = nullptr; }
  LogCollector(const LogCollector&) = delete;
  LogCollector& operator=(const LogCollector&) = delete;

  /// The first message on one line, empty if there was none.
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  static std::atomic<LogCollector*>& active() {
    static std::atomic<LogCollector*> collector{nullptr};
    return collector;
  }

  static GLogWriterOutput write(GLogLevelFlags level, const GLogField* fields, gsize count, gpointer data) {
    LogCollector* const collector = active();
    std::string domain;
    std::string message;
    for (gsize i = 0; i < count; ++i) {
      const bool text = fields[i].length < 0 && fields[i].value != nullptr;
      if (text && std::string_view(fields[i].key) == "GLIB_DOMAIN") domain = static_cast<const char*>(fields[i].value);
      if (text && std::string_view(fields[i].key) == "MESSAGE") message = static_cast<const char*>(fields[i].value);
    }
    if (collector == nullptr || domain != collector->domain_) return g_log_writer_default(level, fields, count, data);
    if (collector->first_.empty()) {
      for (char& c : message) c = c == '\n' ? ' ' : c;
      while (!message.empty() && message.back() == ' ') message.pop_back();
      collector->first_ = message;
    }
    return G_LOG_WRITER_HANDLED;
  }

  const std::string domain_;
  std::string first_;
};

/// Collects the GError of one call: pass out(), then check(). Aravis returns plausible defaults beside an error, so the
/// error is what counts, never the value.
class GErrorSlot {
 public:
  GErrorSlot() = default;
  ~GErrorSlot() { g_clear_error(&error_); }
  GErrorSlot(const GErrorSlot&) = delete;
  GErrorSlot& operator=(const GErrorSlot&) = delete;

  [[nodiscard]] GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  [[nodiscard]] bool failed() const { return error_ != nullptr; }
  [[nodiscard]] std::string message() const { return error_ == nullptr ? "" : error_->message; }

  /// The camera said that it is busy; the same again may succeed.
  [[nodiscard]] bool is_busy() const {
    return g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY) != FALSE;
  }
  [[nodiscard]] bool is_access_denied() const {
    return g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED) != FALSE;
  }

  /// The camera's description cannot be read, or is none.
  [[nodiscard]] bool is_bad_description() const {
    return g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_GENICAM_NOT_FOUND) != FALSE;
  }

  /// True if the device did not answer; false if it answered with a refusal.
  [[nodiscard]] bool is_connection_loss() const {
    return error_ != nullptr && error_->domain == ARV_DEVICE_ERROR &&
           (error_->code == ARV_DEVICE_ERROR_TIMEOUT || error_->code == ARV_DEVICE_ERROR_NOT_CONNECTED ||
            error_->code == ARV_DEVICE_ERROR_NOT_FOUND || error_->code == ARV_DEVICE_ERROR_TRANSFER_ERROR);
  }

  /// Throws Error kCameraDisconnected, or `refused` where the device answered, if the call failed.
  void check(const std::string& what, ErrorCode refused = ErrorCode::kCameraSettings) const {
    if (!failed()) return;
    throw Error(is_connection_loss() ? ErrorCode::kCameraDisconnected : refused, what + ": " + message());
  }

 private:
  GError* error_ = nullptr;
};

}  // namespace fvd
