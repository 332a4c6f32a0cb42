#include <filesystem>
#include <future>

#include "fake_app.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

std::ptrdiff_t openFiles() {
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return std::distance(begin(files), end(files));
}

TEST(Lifecycle, ManyClientsLeaveNoLeak) {
    FakeApp app;
    app.publishEvery(5ms, 64);
    const auto files = openFiles();
    for (int i = 0; i < 150; ++i) {
        const auto client = i % 3 == 0 ? connect(app) : join(app, 60);
        if (i % 2 == 0) client->close();
    }
    EXPECT_TRUE(eventually([&] { return app.counters().sessions == 0; }));
    EXPECT_EQ(app.server().viewers(), 0U);
    EXPECT_EQ(app.counters().accepted, 150U);
    EXPECT_EQ(app.counters().closedBy(CloseCause::Left), 150U);
    EXPECT_TRUE(eventually([&] { return openFiles() == files; }));
}

TEST(Lifecycle, DrainSendsTheQueueThenClosesWith1012) {
    FakeApp app;
    app.publishEvery(5ms, 64);
    const auto viewer = join(app, 60);
    const auto silent = connect(app);
    auto draining = std::async(std::launch::async, [&app] {
        app.server().broadcast(eventOf("stopping", v1::Event::DRAINING));
        app.server().drain();
    });
    bool told = false;
    while (!viewer->closed()) {
        const auto received = viewer->receive(patience);
        if (received && *received && (*received)->has_event()) told = true;
    }
    EXPECT_TRUE(told);
    EXPECT_EQ(viewer->closed()->code, 1012);
    EXPECT_EQ(viewer->closed()->reason, "the server is stopping");
    EXPECT_EQ(readToEnd(*silent).code, 1012);
    EXPECT_EQ(draining.wait_for(1s), std::future_status::ready) << "no session was left";
    // A session is counted just after its connection has been closed.
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::Drained) == 2; }));
    EXPECT_FALSE(Client::connect(app.url(), patience)) << "the server still accepts";
}

TEST(Lifecycle, DrainTimesOutForAClientThatDoesNotRead) {
    Options options = quickOptions();
    options.drainTimeout = 500ms;
    FakeApp app(options);
    app.publishEvery(5ms, 40'000);
    const auto stalled = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.counters().chainsLost > 0; }));
    const auto begin = std::chrono::steady_clock::now();
    app.server().drain();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 1400ms);
    EXPECT_EQ(app.counters().sessions, 0U);
}

TEST(Lifecycle, ServerMayBeDestroyedWithOpenConnections) {
    auto app = std::make_unique<FakeApp>();
    app->publishEvery(5ms, 40'000);
    const auto viewer = join(*app, 60);
    const auto silent = connect(*app);
    const RawSocket request(app->server().port());
    request.send("GET / HT");
    app.reset();
    EXPECT_EQ(readToEnd(*viewer).code, 1006);
    EXPECT_EQ(request.readAll(), "");
}

TEST(Lifecycle, PortInUseIsAnError) {
    FakeApp app;
    Options options = quickOptions();
    options.port = app.server().port();
    const auto second = startServer(options, {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().where, "127.0.0.1:" + std::to_string(options.port));
    EXPECT_NE(second.error().message.find("Address already in use"), std::string::npos) << second.error().message;
}

TEST(Lifecycle, ForeignHostIsAnError) {
    Options options = quickOptions();
    options.host = "192.0.2.1";
    EXPECT_FALSE(startServer(options, {}));
    options.host = "no such host";
    EXPECT_FALSE(startServer(options, {}));
}

}  // namespace
}  // namespace spherule::net
