#include "crowd.h"

#include <boost/asio/executor_work_guard.hpp>

namespace spherule::load {

namespace {

constexpr std::chrono::milliseconds joinedWithin{1000};

Kind kindOf(std::uint32_t index, const Composition& composition) {
    if (index < composition.stalled) return Kind::Stalled;
    index -= composition.stalled;
    if (index < composition.slow) return index % 2 == 0 ? Kind::SlowReading : Kind::LateAcking;
    index -= composition.slow;
    return index < composition.reconnecting ? Kind::Reconnecting : Kind::Healthy;
}

}  // namespace

Crowd::Crowd(const Wish& wish, const Composition& composition, unsigned threads) : size_(composition.viewers) {
    for (unsigned k = 0; k < threads; ++k) shares_.push_back(std::make_unique<Share>());
    std::uint32_t decoding = 0;
    for (std::uint32_t index = 0; index < size_; ++index) {
        const Kind kind = kindOf(index, composition);
        const bool decode = kind == Kind::Healthy && decoding < composition.decode;
        if (decode) ++decoding;
        Share& share = *shares_[index % threads];
        share.viewers.push_back(std::make_unique<Viewer>(share.io, wish, kind, index, decode));
    }
}

Crowd::~Crowd() {
    for (const auto& share : shares_) share->io.stop();
}

void Crowd::start() {
    for (std::size_t s = 0; s < shares_.size(); ++s) {
        Share& share = *shares_[s];
        for (std::size_t k = 0; k < share.viewers.size(); ++k) {
            const auto index = k * shares_.size() + s;
            share.viewers[k]->start(joinedWithin * index / size_);
        }
        share.thread = std::jthread([&io = share.io] {
            const auto work = boost::asio::make_work_guard(io);
            io.run();
        });
    }
}

Tallies Crowd::stop() {
    for (const auto& share : shares_) share->io.stop();
    Tallies tallies;
    for (const auto& share : shares_) {
        share->thread.join();
        for (const auto& viewer : share->viewers) {
            viewer->conclude();
            tallies[static_cast<std::size_t>(viewer->kind())] += viewer->tally();
        }
    }
    shares_.clear();  // closes the connections
    return tallies;
}

}  // namespace spherule::load
