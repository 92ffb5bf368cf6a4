#pragma once

/// Where the program's log goes: to the journal with priority and fields, or to a terminal.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <spdlog/logger.h>

namespace fvd {

/// Takes one entry of the journal, as "NAME=value"; false if it could not be delivered.
using JournalEntry = std::function<bool(const std::vector<std::string>&)>;

/// Logs entries with MESSAGE, PRIORITY (syslog's 2..7), SYSLOG_IDENTIFIER=fvd and the fields of LogScope. What cannot
/// be delivered goes to standard error, with "<priority>" before it.
[[nodiscard]] std::shared_ptr<spdlog::logger> journal_logger(JournalEntry deliver);

/// The journal's logger if standard error is connected to the journal (JOURNAL_STREAM), else one to standard error in
/// colours. warnings: gets lines of level warning and above beside it; null = nothing does. context: once, before any
/// thread starts.
void set_up_service_log(spdlog::sink_ptr warnings = nullptr);

/// The least severe level that goes to the journal or the terminal. What gets warnings beside it gets them whatever the
/// level is. context: any thread.
void set_log_level(spdlog::level::level_enum level);

}  // namespace fvd
