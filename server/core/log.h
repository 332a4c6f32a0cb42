#pragma once

#include <spdlog/spdlog.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace spherule {

enum class LogFormat { Text, Json };

// Sends the log to stderr; stdout is for results. Writes lines of text, or one JSON object per line with "time" (UTC),
// "level" and "message". Call once, from main.
void startLog(bool verbose, LogFormat format);

// Moves the writing of the log to its own thread, so that logging never blocks. Drops the oldest messages when more
// than 1024 wait. The rest is written when the program ends.
void logInBackground();
// Waits up to 1 s until the queued messages are written. Returns false when some are left.
[[nodiscard]] bool logIsWritten();

struct LogField {
    std::string_view name;  // letters and underscores
    std::string value;      // any bytes; invalid UTF-8 is replaced in JSON, control characters in text
};

// Logs a message with fields for programs. In JSON, "event" and each field are members. In text, the fields follow the
// message. Any thread.
void logEvent(spdlog::level::level_enum level, std::string_view event, std::string_view message,
              std::initializer_list<LogField> fields);

}  // namespace spherule
