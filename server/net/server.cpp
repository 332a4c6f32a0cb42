#include "net/server.h"

#include <new>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "net/listener.h"
#include "net/server_state.h"

namespace spherule::net {

namespace {

constexpr std::chrono::seconds dropTime{1};  // for dropped sessions to end

class RunningServer final : public Server {
  public:
    RunningServer(const Options& options, Handlers handlers)
        : scheme_(options.credentials.certificate.empty() ? "http" : "https"),
          state_{.options = options, .handlers = std::move(handlers)},
          listener_(std::make_shared<Listener>(io_, state_)) {}

    RunningServer(const RunningServer&) = delete;
    RunningServer& operator=(const RunningServer&) = delete;

    ~RunningServer() override {
        io_.stop();
        if (thread_.joinable()) thread_.join();
    }

    Result<void> start() {
        const Options& options = state_.options;
        for (const std::string& origin : options.allowedNames.origins)
            if (auto good = checkOrigin(origin); !good) return good;
        for (const std::string& host : options.allowedNames.hosts)
            if (auto good = checkHost(host); !good) return good;
        auto loaded = load(options.credentials);
        if (!loaded) return tl::unexpected(loaded.error());
        apply(std::move(*loaded));
        state_.publishControl(state_.controlLock.state());
        if (auto opened = listener_->open(); !opened) return opened;
        listener_->run();
        thread_ = std::thread([this] { runIo(); });
        return {};
    }

    [[nodiscard]] std::uint16_t port() const override { return listener_->port(); }

    void retain(codec::SharedMessage message, codec::Audience audience) override {
        state_.hub.retain(std::move(message), audience);
    }
    void setOrder(codec::SharedMessage order, codec::Audience audience) override {
        state_.hub.setOrder(std::move(order), audience);
    }
    void follow(codec::SharedMessage population) override { state_.hub.follow(std::move(population)); }
    void refreshScene(codec::SharedMessage scene) override { state_.hub.refreshScene(std::move(scene)); }
    void publish(const codec::EncodedFrame& encoded) override { state_.hub.publish(encoded); }
    void broadcast(codec::SharedMessage message) override { state_.hub.broadcast(message); }
    void announce(SessionId by, v1::Event event) override { state_.hub.announce(by, std::move(event)); }

    void reply(SessionId session, v1::CommandResult result) override {
        v1::ServerMessage message;
        *message.mutable_result() = std::move(result);
        state_.hub.sendTo(session, std::make_shared<codec::Message>(std::move(message)));
    }

    [[nodiscard]] std::uint32_t viewers() const override { return state_.hub.viewers(); }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() override { return state_.hub.subscriptions(); }
    [[nodiscard]] const Counters& counters() const override { return state_.counters; }

    Result<void> setCredentials(const Credentials& credentials) override {
        auto loaded = load(credentials);
        if (!loaded) return tl::unexpected(loaded.error());
        boost::asio::post(io_, [this, next = std::move(*loaded)] { apply(next); });
        return {};
    }

    void stopAccepting() override {
        boost::asio::post(io_, [listener = listener_] { listener->close(); });
    }

    void drain() override {
        stopAccepting();
        state_.hub.drain();
        if (state_.hub.waitEmpty(state_.options.drainTimeout)) return;
        state_.hub.dropAll();
        state_.hub.waitEmpty(dropTime);
    }

  private:
    // An exception of a handler ends only its session or connection, so the loop goes on.
    void runIo() {
        while (!io_.stopped()) {
            try {
                io_.run();
            } catch (const std::bad_alloc&) {
                ++state_.counters.rejectedFor(RejectReason::Fault);  // logging would need memory
            } catch (const std::exception& error) {
                state_.rejectionLog.rejected(RejectReason::Fault, error.what());
            }
        }
    }

    // Credentials in the form that connections use.
    struct LoadedCredentials {
        std::shared_ptr<const Admission> admission;
        Tls tls;
    };

    [[nodiscard]] Result<LoadedCredentials> load(const Credentials& credentials) const {
        if (requiresToken(credentials) != requiresToken(state_.options.credentials))
            return fail(ErrorKind::Input, "tokens", "cannot be turned on or off while the server runs");
        AllowedNames allowedNames = state_.options.allowedNames;
        allowedNames.hosts.push_back(state_.options.host);  // the address that was announced to users
        LoadedCredentials loaded{
            .admission = std::make_shared<Admission>(std::move(allowedNames), credentials, scheme_), .tls = nullptr};
        if (credentials.certificate.empty() == (scheme_ == "http")) {
            if (credentials.certificate.empty()) return loaded;
            auto tls = serverTls(credentials);
            if (!tls) return tl::unexpected(tls.error());
            loaded.tls = std::move(*tls);
            return loaded;
        }
        return fail(ErrorKind::Input, "--tls-certificate", "cannot be turned on or off while the server runs");
    }

    void apply(const LoadedCredentials& loaded) {
        state_.admission = loaded.admission;
        state_.tls = loaded.tls;
    }

    boost::asio::io_context io_{1};
    std::string scheme_;
    ServerState state_;  // after io_: sessions must be destroyed before their executor
    std::shared_ptr<Listener> listener_;
    std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Server>> startServer(const Options& options, Handlers handlers) {
    auto server = std::make_unique<RunningServer>(options, std::move(handlers));
    if (auto started = server->start(); !started) return tl::unexpected(started.error());
    return server;
}

}  // namespace spherule::net
