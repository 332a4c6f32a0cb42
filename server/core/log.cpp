#include "core/log.h"

#include <fmt/chrono.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace spherule {

namespace {

constexpr const char* loggerName = "spherule";

// What belongs to the message that this thread logs: spdlog formats it before the call returns.
struct Event {
    std::string_view name;
    std::initializer_list<LogField> fields;
};
thread_local const Event* current = nullptr;

class JsonLines final : public spdlog::formatter {
  public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
        const auto time = std::chrono::time_point_cast<std::chrono::milliseconds>(message.time).time_since_epoch();
        const auto level = spdlog::level::to_string_view(message.level);
        nlohmann::ordered_json json = {
            {"time", fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(message.time), time.count() % 1000)},
            {"level", std::string_view(level.data(), level.size())},
            {"message", std::string_view(message.payload.data(), message.payload.size())}};
        if (current != nullptr) {
            json["event"] = current->name;
            for (const LogField& field : current->fields) json[std::string(field.name)] = field.value;
        }
        const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        line.append(text.data(), text.data() + text.size());
    }
    [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<JsonLines>(); }
};

std::string asText(std::string_view message, std::initializer_list<LogField> fields) {
    std::string text(message);
    for (const LogField& field : fields) text += fmt::format(" {}={}", field.name, field.value);
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
    return text;
}

bool isJson = false;

}  // namespace

void startLog(bool verbose, LogFormat format) {
    spdlog::drop(loggerName);
    isJson = format == LogFormat::Json;
    auto logger = isJson ? spdlog::stderr_logger_mt(loggerName) : spdlog::stderr_color_mt(loggerName);
    if (isJson)
        logger->set_formatter(std::make_unique<JsonLines>());
    else
        logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
    logger->set_level(verbose ? spdlog::level::debug : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

void logEvent(spdlog::level::level_enum level, std::string_view event, std::string_view message,
              std::initializer_list<LogField> fields) {
    if (!spdlog::should_log(level)) return;
    if (!isJson) return spdlog::log(level, "{}", asText(message, fields));
    const Event here{event, fields};
    current = &here;
    spdlog::log(level, "{}", message);
    current = nullptr;
}

}  // namespace spherule
