#include "net/server.h"

#include <new>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "net/context.h"
#include "net/listener.h"

namespace spherule::net {

namespace {

constexpr std::chrono::seconds dropTime{1};  // for sessions to notice that they were dropped

class RunningServer final : public Server {
  public:
    RunningServer(const Options& options, Handlers handlers)
        : scheme_(options.credentials.certificate.empty() ? "http" : "https"),
          context_{.options = options, .handlers = std::move(handlers)},
          listener_(std::make_shared<Listener>(io_, context_)) {}

    RunningServer(const RunningServer&) = delete;
    RunningServer& operator=(const RunningServer&) = delete;

    ~RunningServer() override {
        io_.stop();
        if (thread_.joinable()) thread_.join();
    }

    Result<void> start() {
        const Options& options = context_.options;
        for (const std::string& origin : options.allowedNames.origins)
            if (auto good = checkOrigin(origin); !good) return good;
        for (const std::string& host : options.allowedNames.hosts)
            if (auto good = checkHost(host); !good) return good;
        auto made = make(options.credentials);
        if (!made) return tl::unexpected(made.error());
        take(std::move(*made));
        context_.tellControl(context_.lease.state());
        if (auto opened = listener_->open(); !opened) return opened;
        listener_->run();
        thread_ = std::thread([this] { work(); });
        return {};
    }

    [[nodiscard]] std::uint16_t port() const override { return listener_->port(); }

    void retain(codec::SharedMessage message) override { context_.hub.retain(std::move(message)); }
    void setOrder(codec::SharedMessage order) override { context_.hub.setOrder(std::move(order)); }
    void publish(const codec::EncodedFrame& encoded) override { context_.hub.publish(encoded); }
    void broadcast(codec::SharedMessage message) override { context_.hub.broadcast(message); }

    void reply(SessionId session, v1::CommandResult result) override {
        v1::ServerMessage message;
        *message.mutable_result() = std::move(result);
        context_.hub.sendTo(session, std::make_shared<codec::Message>(std::move(message)));
    }

    [[nodiscard]] std::uint32_t viewers() const override { return context_.hub.viewers(); }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() override { return context_.hub.subscriptions(); }
    [[nodiscard]] const Counters& counters() const override { return context_.counters; }

    Result<void> setCredentials(const Credentials& credentials) override {
        auto made = make(credentials);
        if (!made) return tl::unexpected(made.error());
        boost::asio::post(io_, [this, taken = std::move(*made)] { take(taken); });
        return {};
    }

    void stopAccepting() override {
        boost::asio::post(io_, [listener = listener_] { listener->close(); });
    }

    void drain() override {
        stopAccepting();
        context_.hub.drain();
        if (context_.hub.waitEmpty(context_.options.drainTimeout)) return;
        context_.hub.dropAll();
        context_.hub.waitEmpty(dropTime);
    }

  private:
    // What a handler throws ends what the handler was for, and nothing else.
    void work() {
        while (!io_.stopped()) {
            try {
                io_.run();
            } catch (const std::bad_alloc&) {
                ++context_.counters.rejectedFor(Rejection::Fault);  // to tell of it takes memory
            } catch (const std::exception& error) {
                context_.refusals.add(Rejection::Fault, error.what());
            }
        }
    }

    // What is made of the credentials.
    struct Keys {
        std::shared_ptr<const Admission> admission;
        Tls tls;
    };

    [[nodiscard]] Result<Keys> make(const Credentials& credentials) const {
        if (requiresToken(credentials) != requiresToken(context_.options.credentials))
            return fail(ErrorKind::Input, "tokens", "cannot come or go while the server runs");
        AllowedNames allowedNames = context_.options.allowedNames;
        allowedNames.hosts.push_back(context_.options.host);  // by which people were told to come
        Keys keys{.admission = std::make_shared<Admission>(std::move(allowedNames), credentials, scheme_),
                  .tls = nullptr};
        if (credentials.certificate.empty() == (scheme_ == "http")) {
            if (credentials.certificate.empty()) return keys;
            auto tls = serverTls(credentials);
            if (!tls) return tl::unexpected(tls.error());
            keys.tls = std::move(*tls);
            return keys;
        }
        return fail(ErrorKind::Input, "--tls-certificate", "cannot come or go while the server runs");
    }

    void take(const Keys& keys) {
        context_.admission = keys.admission;
        context_.tls = keys.tls;
    }

    boost::asio::io_context io_{1};
    std::string scheme_;
    Context context_;  // after io_: the hub lets go of its sessions while their executor still exists
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
