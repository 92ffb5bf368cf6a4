#pragma once

/// Tells systemd how the service is doing (sd_notify(3)); silent where systemd did not start it.

#include <string>

namespace fvd {

void notify_ready(const std::string& status);
void notify_status(const std::string& status);
void notify_stopping();

}  // namespace fvd
