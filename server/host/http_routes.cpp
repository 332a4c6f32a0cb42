#include "host/http_routes.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <array>
#include <utility>

#include "embedded/page.h"

namespace spherule::host {

namespace {

std::string_view typeOf(std::string_view path) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 7> types = {{
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".webp", "image/webp"},
        {".ico", "image/x-icon"},
    }};
    for (const auto& [suffix, type] : types)
        if (path.ends_with(suffix)) return type;
    return "application/octet-stream";
}

net::HttpAnswer file(std::string_view path) {
    const std::string_view name = path == "/" ? "index.html" : path.substr(1);
    for (const embedded::File& file : embedded::page())
        if (file.path == name) return {200, std::string(typeOf(name)), std::string(file.bytes)};
    return {404, "text/plain; charset=utf-8", "There is nothing here. The page is at /.\n"};
}

// Answers 503 when half of the watchdog's limit has passed without progress, so that users see it before the watchdog
// ends the program. A slow server makes progress, so the answer is 200.
net::HttpAnswer health(const Watchdog& watchdog, const std::string& slow) {
    const auto silence = watchdog.silence();
    if (2 * silence <= watchdog.limit())
        return {200, "text/plain; charset=utf-8", slow.empty() ? "alive\n" : "alive, but slow: " + slow + "\n"};
    return {503, "text/plain; charset=utf-8",
            fmt::format("stuck: nothing has progressed for {:.1f} s; after {:g} s the watchdog ends it\n",
                        silence.count(), watchdog.limit().count())};
}

net::HttpAnswer readiness(const ServerStatus& status) {
    const nlohmann::ordered_json json = {{"state", status.state},
                                         {"device", status.device.kind},
                                         {"renderer", status.device.renderer},
                                         {"reason", status.device.reason},
                                         {"scene", status.scene},
                                         {"spheres", status.spheres},
                                         {"steps", status.steps},
                                         {"realTimeFactor", status.status.real_time_factor()}};
    const bool ready = status.state == "running" || status.state == "paused";
    return {ready ? 200 : 503, "application/json",
            json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"};
}

}  // namespace

net::HttpAnswer HttpRoutes::get(const std::string& path, const net::Counters& counters) {
    if (path == "/healthz") return health(watchdog_, board_.read().slow);
    if (path == "/readyz") return readiness(board_.read());
    if (path == "/metrics") {
        board_.noteRead();
        return {200, "text/plain; version=0.0.4", metrics_.text(board_.read(), counters)};
    }
    return file(path);
}

}  // namespace spherule::host
