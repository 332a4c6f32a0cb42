#include <unistd.h>

#include <fstream>

#include "fake_app.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

#ifdef SANITIZED
constexpr bool memoryIsMeasurable = false;  // sanitizers do not return freed memory
#else
constexpr bool memoryIsMeasurable = true;
#endif

double residentMegabytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t pages = 0;
    file >> pages >> pages;
    return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

constexpr std::uint8_t binaryFrame = 0x82;
constexpr std::uint8_t pingFrame = 0x89;
constexpr std::uint8_t pongFrame = 0x8a;

std::string helloBytes(std::uint32_t rate) {
    return helloOf(rate).SerializeAsString();
}

// Opens the stream at 60 frames per second and waits until the server counts the viewer.
void becomeViewer(const RawSocket& socket, FakeApp& app) {
    ASSERT_EQ(socket.openStream().substr(0, 12), "HTTP/1.1 101");
    socket.sendFrame(binaryFrame, helloBytes(60));
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
}

TEST(SlowClients, ThatStopReadingAreDroppedWithoutDelayingOthers) {
    Options options = quickOptions();
    options.progressTimeout = 2s;
    FakeApp app(options);
    constexpr std::uint32_t spheres = 40'000;  // 240 kB per frame
    app.publishEvery(25ms, spheres);
    const auto healthy = join(app, 60);
    for (int i = 0; i < 10; ++i) next(*healthy);  // lets the server reach its normal memory
    constexpr int undisturbed = 40;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < undisturbed; ++i) next(*healthy);
    const double rate = undisturbed / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const auto stalled = join(app, 60);
    const double before = residentMegabytes();
    double most = before;
    const auto begin = std::chrono::steady_clock::now();
    int states = 0;
    while (app.counters().closedBy(CloseCause::Stalled) == 0 && std::chrono::steady_clock::now() - begin < patience) {
        EXPECT_TRUE(next(*healthy).has_frame());
        ++states;
        most = std::max(most, residentMegabytes());
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_EQ(app.counters().closedBy(CloseCause::Stalled), 1U);
    EXPECT_GT(seconds, 1.9) << "closed before the limit";
    EXPECT_LT(seconds, 5) << "closed long after the limit";
    EXPECT_GE(app.counters().chainsLost, 1U);
    EXPECT_GT(states / seconds, 0.6 * rate) << "of states per second before";
    if (memoryIsMeasurable) {
        EXPECT_LT(most - before, 8) << "MB more; the frames of that time take 20 MB";
    }
    EXPECT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    EXPECT_TRUE(next(*healthy).has_frame());
}

// A ping is an answer that waits behind the unsent data. The cause stays that the client does not read.
TEST(SlowClients, ThatSendPingsButReadNothingCountAsStalled) {
    Options options = quickOptions();
    options.progressTimeout = 1s;
    FakeApp app(options);
    const RawSocket slow(app.server().port(), 16 * 1024);
    ASSERT_NO_FATAL_FAILURE(becomeViewer(slow, app));
    app.publishEvery(25ms, 40'000);  // 240 kB each
    const auto begin = std::chrono::steady_clock::now();
    while (app.server().viewers() == 1 && std::chrono::steady_clock::now() - begin < patience) {
        slow.sendFrame(pingFrame, "");
        std::this_thread::sleep_for(100ms);
    }
    EXPECT_TRUE(eventually([&] { return app.server().viewers() == 0; }));
    EXPECT_EQ(app.counters().closedBy(CloseCause::Stalled), 1U);
    EXPECT_EQ(app.counters().closedBy(CloseCause::Left), 0U);
}

// Frames in the kernel's buffer get stale.
TEST(SlowClients, ThatReadNothingHaveFewBytesInFlight) {
    FakeApp app;
    const RawSocket slow(app.server().port(), 16 * 1024);
    ASSERT_NO_FATAL_FAILURE(becomeViewer(slow, app));
    app.publishEvery(5ms, 20'000);  // 120 kB each
    ASSERT_TRUE(eventually([&] { return app.published() > 60; }));
    EXPECT_EQ(app.counters().framesSent, 0U) << "no frame fits into the kernel's buffer";
    EXPECT_GE(app.counters().chainsLost, 1U);
}

TEST(SlowClients, ThatReadSteadilyStayConnected) {
    Options options = quickOptions();
    options.progressTimeout = 1s;
    options.idleTimeout = 1500ms;
    FakeApp app(options);
    const RawSocket slow(app.server().port(), 64 * 1024);
    ASSERT_NO_FATAL_FAILURE(becomeViewer(slow, app));
    constexpr std::uint32_t spheres = 700'000;
    constexpr std::size_t frameBytes = std::size_t{6} * spheres;
    app.publish(spheres);

    const auto begin = std::chrono::steady_clock::now();
    std::size_t received = 0;
    while (received < frameBytes) {
        const std::string some = slow.readSome(std::size_t{32} * 1024);
        ASSERT_FALSE(some.empty()) << "dropped after " << received << " bytes";
        received += some.size();
        std::this_thread::sleep_for(25ms);
    }
    EXPECT_GT(std::chrono::steady_clock::now() - begin, 2 * options.progressTimeout) << "too fast to prove anything";
    EXPECT_EQ(app.counters().closedBy(CloseCause::Stalled) + app.counters().closedBy(CloseCause::Silent), 0U);
}

TEST(SlowClients, ThatVanishAreDropped) {
    Options options = quickOptions();
    options.idleTimeout = 600ms;
    FakeApp app(options);
    const auto present = join(app, 0);
    const auto vanished = join(app, 0);
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < 2s) {
        ASSERT_TRUE(present->receive(50ms)) << "only receive() answers pings";
    }
    EXPECT_EQ(app.counters().closedBy(CloseCause::Silent), 1U);
    EXPECT_EQ(app.counters().sessions, 1U);
    EXPECT_FALSE(present->closed());
}

TEST(SlowClients, ArePingedAtHalfTheIdleTime) {
    Options options = quickOptions();
    options.idleTimeout = 600ms;
    FakeApp app(options);
    const RawSocket socket(app.server().port());
    ASSERT_EQ(socket.openStream().substr(0, 12), "HTTP/1.1 101");
    socket.sendFrame(binaryFrame, helloBytes(0));
    const std::string ping("\x89\x00", 2);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NE(socket.readUntil(ping).find(ping), std::string::npos);
        socket.sendFrame(pongFrame, "");
    }
    EXPECT_EQ(app.counters().closedBy(CloseCause::Silent), 0U);
}

TEST(SlowClients, WithAFullSendQueueAreClosedWith1013) {
    Options options = quickOptions();
    options.controlQueue = 8;
    FakeApp app(options);
    const auto slow = join(app, 0);
    const auto event = eventOf(std::string(300'000, 'x'));
    for (int i = 0; i < 100; ++i) app.server().broadcast(event);
    const auto end = readToEnd(*slow);
    EXPECT_EQ(end.code, 1013);
    EXPECT_EQ(end.reason, "too many messages wait for this client to read them");
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::Overflow) == 1; }));
}

TEST(SlowClients, ThatIgnoreTheCloseFrameAreDropped) {
    Options options = quickOptions();
    options.controlQueue = 8;
    options.progressTimeout = 500ms;
    FakeApp app(options);
    const auto slow = join(app, 0);
    const auto event = eventOf(std::string(300'000, 'x'));
    for (int i = 0; i < 100; ++i) app.server().broadcast(event);
    EXPECT_TRUE(eventually([&] { return app.counters().sessions == 0; }));
    EXPECT_EQ(app.counters().closedBy(CloseCause::Overflow), 1U);
}

}  // namespace
}  // namespace spherule::net
