#include "host/http_routes.h"

#include <fmt/format.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/text.h"

namespace spherule::host {

namespace {

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

// The name is only compared with the names of known files, so no other file can be reached.
std::optional<std::string> HttpRoutes::download(const std::string& path) const {
    if (!path.starts_with(net::downloadsPath)) return std::nullopt;
    const std::string name = path.substr(net::downloadsPath.size());
    const ServerStatus status = board_.read();
    for (const std::string& file : status.recordings) {
        if (std::filesystem::path(file).filename() != name) continue;
        const bool open = status.recording.active() && status.recording.file() == utf8(file);
        return open ? std::nullopt : std::optional(file);
    }
    return std::nullopt;
}

net::HttpAnswer HttpRoutes::get(const std::string& path, const net::Counters& counters) {
    if (path == "/healthz") return health(watchdog_, board_.read().slow);
    if (path == "/readyz") return readiness(board_.read());
    if (path == "/metrics") {
        board_.noteRead();
        return {200, "text/plain; version=0.0.4", metrics_.text(board_.read(), counters)};
    }
    if (path.starts_with(net::downloadsPath))
        return {404, "text/plain; charset=utf-8", "This server has not written and finished such a recording.\n"};
    return {404, "text/plain; charset=utf-8", "There is nothing here. The page is at /.\n"};
}

}  // namespace spherule::host
