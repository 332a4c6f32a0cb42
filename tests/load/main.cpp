#include <spdlog/fmt/fmt.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "client/client.h"
#include "client/url.h"
#include "crowd.h"
#include "report.h"

// Connects many viewers to one server, some of them misbehaving. Checks the received messages and their age.

namespace {

using namespace spherule;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

struct Options {
    std::string url;
    load::Composition who;
    std::uint32_t seconds = 60;
    std::uint32_t warmUp = 3;
    std::uint32_t rate = 20;
    v1::Tier tier = v1::NORMAL;
    bool fixed = false;
    std::size_t slowBytes = 20'000;
    std::uint32_t lateMs = 1000;
    std::uint32_t stay = 3;
    unsigned threads = 1;
    std::optional<pid_t> server;
    bool markdown = false;
};

void declare(CLI::App& app, Options& options) {
    static const std::map<std::string, v1::Tier> tiers = {{"fine", v1::FINE}, {"normal", v1::NORMAL}, {"eco", v1::ECO}};
    app.add_option("url", options.url, "ws://HOST:PORT/ws")->required();
    app.add_option("--viewers", options.who.viewers, "total number of viewers")
        ->capture_default_str()
        ->check(CLI::Range(1, 20'000));
    app.add_option("--stalled", options.who.stalled, "viewers that stop reading after their first frame");
    app.add_option("--slow", options.who.slow, "slow viewers: half of them read slowly, half acknowledge late");
    app.add_option("--reconnecting", options.who.reconnecting, "viewers that reconnect every few seconds");
    app.add_option("--decode", options.who.decode, "healthy viewers that decode all frames and compare hashes");
    app.add_option("--seconds", options.seconds, "duration of the measurement (s)")
        ->capture_default_str()
        ->check(CLI::Range(1, 86'400));
    app.add_option("--warm-up", options.warmUp,
                   "time before the measurement (s); content is checked, ages and rates are not counted")
        ->capture_default_str()
        ->check(CLI::Range(1, 3'600));
    app.add_option("--rate", options.rate, "requested frames per second")
        ->capture_default_str()
        ->check(CLI::Range(1, 60));
    app.add_option("--tier", options.tier, "fine, normal or eco")
        ->transform(CLI::CheckedTransformer(tiers))
        ->default_str("normal");
    app.add_flag("--fixed", options.fixed, "viewers refuse lower renditions");
    app.add_option("--slow-bytes", options.slowBytes, "bytes per second of a viewer that reads slowly")
        ->capture_default_str()
        ->check(CLI::Range(1, 1'000'000'000));
    app.add_option("--late-ms", options.lateMs, "delay of a late ack (ms)")->capture_default_str();
    app.add_option("--stay", options.stay, "longest session of a reconnecting viewer (s)")
        ->capture_default_str()
        ->check(CLI::Range(1, 3'600));
    app.add_option("--threads", options.threads, "threads of this client")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    app.add_option("--server-pid", options.server, "also report CPU time and memory of this process")
        ->check(CLI::PositiveNumber);
    app.add_flag("--markdown", options.markdown, "write tables as Markdown");
    app.footer(
        "Faults: messages that docs/protocol.md or docs/codec.md do not allow, a disconnected healthy viewer, and a\n"
        "healthy viewer without frames for 5 s (so the scene must run). SPHERULE_TOKEN is the token for the server.\n\n"
        "Exit codes: 0 no faults, 1 faults, 2 usage, or no server.");
}

void check(const Options& options) {
    const auto& who = options.who;
    const std::uint64_t bad = std::uint64_t{who.stalled} + who.slow + who.reconnecting;
    if (bad > who.viewers)
        throw std::runtime_error(fmt::format("{} are stalled, slow or reconnecting, of {} viewers", bad, who.viewers));
    if (who.decode > who.viewers - bad)
        throw std::runtime_error(
            fmt::format("--decode {}: there are {} healthy viewers", who.decode, who.viewers - bad));
}

load::Wish wishOf(const Options& options) {
    const auto url = client::parseUrl(options.url);
    if (!url) throw std::runtime_error(url.error().text());
    boost::asio::io_context io;
    boost::system::error_code error;
    const auto found = boost::asio::ip::tcp::resolver(io).resolve(url->host, url->port, error);
    if (error) throw std::runtime_error(options.url + ": " + error.message());
    // Choose an address that answers: a name may have addresses without a server.
    boost::asio::ip::tcp::socket socket(io);
    const auto server = boost::asio::connect(socket, found, error);
    if (error) throw std::runtime_error(options.url + ": cannot be reached: " + error.message());
    const char* const token = std::getenv("SPHERULE_TOKEN");
    return {.server = server,
            .url = *url,
            .token = token == nullptr ? "" : token,
            .tier = options.tier,
            .rate = options.rate,
            .fixed = options.fixed,
            .slowBytes = options.slowBytes,
            .lateAck = std::chrono::milliseconds(options.lateMs),
            .stay = std::chrono::seconds(options.stay),
            .measureFrom = Clock::now() + std::chrono::seconds(options.warmUp)};
}

double ownCpuSeconds() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

load::Outcome run(const Options& options) {
    load::Outcome outcome;
    const auto look = [&] { return options.server ? load::usageOf(*options.server) : std::nullopt; };
    if (options.server) {
        const auto before = look();
        if (!before) throw std::runtime_error(fmt::format("--server-pid {}: no process to look at", *options.server));
        outcome.server = load::ServerUsage{.before = *before, .during = {}, .after = {}};
    }
    const load::Wish wish = wishOf(options);
    load::Crowd crowd(wish, options.who, options.threads);
    crowd.start();
    std::this_thread::sleep_until(wish.measureFrom);
    const auto began = Clock::now();
    const double cpu = ownCpuSeconds();
    for (std::uint32_t second = 0;; ++second) {
        if (const auto usage = look()) outcome.server->during.push_back(*usage);
        if (second % 5 == 0 || second == options.seconds) fmt::print(stderr, "{} of {} s\n", second, options.seconds);
        if (second == options.seconds) break;
        std::this_thread::sleep_until(began + (second + 1) * 1s);
    }
    outcome.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    outcome.cpuSeconds = ownCpuSeconds() - cpu;
    outcome.tallies = crowd.stop();
    if (outcome.server) {
        std::this_thread::sleep_for(2s);  // lets the server notice the disconnects
        outcome.server->after = look();
    }
    return outcome;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Checks and times what many viewers of a running `spherule serve` are sent", "spherule_load");
    Options options;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        check(options);
        const load::Outcome outcome = run(options);
        fmt::print("{}", load::reportOf(outcome, options.markdown));
        for (const load::Tally& tally : outcome.tallies)
            if (tally.faultCount > 0) return 1;
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "spherule_load: {}\n", error.what());
        return 2;
    }
}
