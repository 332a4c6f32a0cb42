#include "core/log.h"

#include <fmt/chrono.h>
#include <spdlog/async.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <thread>

namespace spherule {

namespace {

constexpr const char* loggerName = "spherule";
constexpr std::size_t mostWaiting = 1024;  // messages

// Marks a message that already consists of the members of a JSON object.
constexpr const char* membersMark = "event";

nlohmann::ordered_json objectOf(std::string_view message) {
    return {{"message", message}};
}

// Serialises an object without its braces; replaces invalid UTF-8.
std::string membersOf(const nlohmann::ordered_json& object) {
    const std::string text = object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.substr(1, text.size() - 2);
}

class JsonLines final : public spdlog::formatter {
  public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
        const auto time = std::chrono::time_point_cast<std::chrono::milliseconds>(message.time).time_since_epoch();
        const auto level = spdlog::level::to_string_view(message.level);
        const std::string_view payload(message.payload.data(), message.payload.size());
        const std::string text =
            fmt::format(R"({{"time":"{:%Y-%m-%dT%H:%M:%S}.{:03}Z","level":"{}",{}}})"
                        "\n",
                        fmt::gmtime(message.time), time.count() % 1000, std::string_view(level.data(), level.size()),
                        message.source.funcname == membersMark ? std::string(payload) : membersOf(objectOf(payload)));
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

void use(std::shared_ptr<spdlog::logger> logger, spdlog::level::level_enum level) {
    if (isJson)
        logger->set_formatter(std::make_unique<JsonLines>());
    else
        logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
    logger->set_level(level);
    spdlog::set_default_logger(std::move(logger));
}

}  // namespace

void startLog(bool verbose, LogFormat format) {
    isJson = format == LogFormat::Json;
    use(isJson ? spdlog::stderr_logger_mt(loggerName) : spdlog::stderr_color_mt(loggerName),
        verbose ? spdlog::level::debug : spdlog::level::info);
}

void logInBackground() {
    const auto now = spdlog::default_logger();
    spdlog::init_thread_pool(mostWaiting, 1);
    use(std::make_shared<spdlog::async_logger>(loggerName, now->sinks().begin(), now->sinks().end(),
                                               spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest),
        now->level());
}

bool logIsWritten() {
    const auto pool = spdlog::thread_pool();
    if (!pool) return true;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (pool->queue_size() > 0 && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // for the last message, which has left the queue
    return pool->queue_size() == 0;
}

void logEvent(spdlog::level::level_enum level, std::string_view event, std::string_view message,
              std::initializer_list<LogField> fields) {
    if (!spdlog::should_log(level)) return;
    if (!isJson) return spdlog::log(level, "{}", asText(message, fields));
    nlohmann::ordered_json object = objectOf(message);
    object["event"] = event;
    for (const LogField& field : fields) object[std::string(field.name)] = field.value;
    spdlog::default_logger_raw()->log(spdlog::source_loc{membersMark, 1, membersMark}, level, "{}", membersOf(object));
}

}  // namespace spherule
