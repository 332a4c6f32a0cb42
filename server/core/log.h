#pragma once

#include <spdlog/spdlog.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace spherule {

enum class LogFormat { Text, Json };

// Sends the program's log to stderr, so that stdout stays free for results: lines of text, or one JSON object a line
// with "time" (UTC), "level" and "message". Call once, from main.
void startLog(bool verbose, LogFormat format);

// From here on a thread of its own writes the log: who logs never waits for whoever reads it, and when too much waits,
// the oldest is left out. What is left is written when the program ends.
void logInBackground();
// Waits for that, a second at most; false where nobody takes it.
[[nodiscard]] bool logIsWritten();

struct LogField {
    std::string_view name;  // of letters and underscores
    std::string value;      // any bytes: what is no UTF-8 is replaced in JSON, what is not printable in text
};

// A message with what a program may want to know of it: as JSON, "event" and each field are members; as text, the
// fields follow the message. Any thread.
void logEvent(spdlog::level::level_enum level, std::string_view event, std::string_view message,
              std::initializer_list<LogField> fields);

}  // namespace spherule
