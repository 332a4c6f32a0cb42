#include "app/chains.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "codec/order.h"
#include "sim/morton.h"
#include "sim/pass.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;

// After a keyframe, the next frame cannot be predicted from velocities, which makes it larger for every viewer of the
// chain. So a viewer that loses the chain again waits before it gets a keyframe.
constexpr auto keyframesEvery = 250ms;
constexpr auto newcomersEvery = 50ms;
constexpr auto retryEvery = 10s;
constexpr auto hashEvery = 1s;
constexpr auto copyWait = 1ms;

std::uint64_t microsecondsNow() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

Chains::Chains(compute::Device& device, Publish publish, Announce announceOrder, Complain complain)
    : device_(device),
      publish_(std::move(publish)),
      announceOrder_(std::move(announceOrder)),
      complain_(std::move(complain)) {}

void Chains::serve(const Scenery& world, const std::vector<codec::Subscription>& subscriptions, Clock::time_point now) {
    if (world.epoch != epoch_) chains_.clear();
    version_ = world.version;
    std::erase_if(chains_, [&](const auto& entry) {
        return std::ranges::find(subscriptions, entry.first, &codec::Subscription::rendition) == subscriptions.end();
    });
    if (world.spheres == 0) return;
    for (auto& [rendition, chain] : chains_) collect(rendition, chain);
    std::vector<std::pair<codec::Rendition, Chain*>> making;
    for (const codec::Subscription& subscription : subscriptions) {
        Chain* const chain = served(subscription, world, now);
        if (chain == nullptr) continue;
        if (!chain->making) begin(subscription, *chain, world, now);
        if (chain->making) making.emplace_back(subscription.rendition, chain);
    }
    // The device copies only a few frames at a time, so the oldest goes first.
    std::ranges::sort(making, {}, [](const auto& entry) { return entry.second->turn; });
    for (const auto& [rendition, chain] : making) collect(rendition, *chain);
}

Chains::Chain* Chains::served(const codec::Subscription& subscription, const Scenery& world, Clock::time_point now) {
    if (!chains_.contains(subscription.rendition) && now < retry_ && world.epoch == refusedEpoch_) return nullptr;
    auto chain = chainOf(subscription.rendition, world);
    if (chain) return *chain;
    complain_(fmt::format("Viewers of {} at {}/s get no frames: {}.", v1::Tier_Name(subscription.rendition.tier),
                          subscription.rendition.rate, chain.error().text()));
    retry_ = now + retryEvery;
    refusedEpoch_ = world.epoch;
    return nullptr;
}

Result<void> Chains::open(const codec::Rendition& rendition, const Scenery& world) {
    if (world.epoch != epoch_) chains_.clear();
    if (world.spheres == 0) return {};
    auto chain = chainOf(rendition, world);
    if (!chain) return tl::unexpected(chain.error());
    return {};
}

// Creates the order of the spheres for an epoch. Neighbours at its beginning stay near each other for long.
Result<void> Chains::prepare(const Scenery& world) {
    const bool slots = world.source.slotOf != nullptr;
    if (!tools_ || tools_->spheres() != world.spheres || slots_ != slots) {
        tools_.reset();
        auto made = sim::TierTools::create(device_, world.spheres, slots);
        if (!made) return tl::unexpected(made.error());
        tools_ = std::move(*made);
        slots_ = slots;
    }
    const std::vector<std::uint32_t> order = sim::mortonOrder(world.positions().position);
    tools_->setOrder(order);
    epoch_ = world.epoch;
    v1::ServerMessage message;
    *message.mutable_order() = codec::orderMessage(epoch_, ++order_, order);
    announceOrder_(codec::share(std::move(message)));
    return {};
}

Result<Chains::Chain*> Chains::chainOf(const codec::Rendition& rendition, const Scenery& world) {
    if (const auto known = chains_.find(rendition); known != chains_.end()) return &known->second;
    if (world.epoch != epoch_)
        if (auto done = prepare(world); !done) return tl::unexpected(done.error());
    auto tier = sim::Tier::create(*tools_, {.quantum = codec::quantumOf(rendition.tier, world.smallestRadius)});
    if (!tier) return tl::unexpected(tier.error());
    Chain& chain = chains_[rendition];
    chain.tier = std::move(*tier);
    return &chain;
}

// In a slow world the next frame is always due. Then keyframes for waiting viewers and frames for all viewers
// alternate.
void Chains::begin(const codec::Subscription& subscription, Chain& chain, const Scenery& world, Clock::time_point now) {
    using enum codec::EncodedFrame::Kind;
    const bool begun = chain.tier->number() > 0;
    const bool due = now >= chain.next && chain.version != world.version;
    const auto since = now - chain.keyframe;
    const bool waits =
        begun && ((subscription.newcomer && since >= newcomersEvery) || (subscription.lost && since >= keyframesEvery));
    if (waits && (!due || chain.kind == Delta)) return start(chain, Resync, chain.newest, world.source, now);
    if (begun && !due) return;
    const auto interval = std::chrono::duration_cast<Clock::duration>(1s) / subscription.rendition.rate;
    chain.next = std::max(chain.next + interval, now - interval / 2);
    chain.version = world.version;
    chain.newest = world.head();
    chain.newest.set_epoch(epoch_);
    chain.newest.set_order(order_);
    chain.newest.set_count(world.spheres);
    chain.newest.set_tier(subscription.rendition.tier);
    chain.newest.set_quantum(codec::quantumOf(subscription.rendition.tier, world.smallestRadius));
    start(chain, begun ? Delta : Keyframe, chain.newest, world.source, now);
}

void Chains::start(Chain& chain, codec::EncodedFrame::Kind kind, v1::Frame head, const sim::TierSource& source,
                   Clock::time_point now) {
    const bool hash = now - chain.hash >= hashEvery;
    if (hash) chain.hash = now;
    device_.beginTimer(static_cast<unsigned>(sim::Pass::Pack));
    switch (kind) {
        case codec::EncodedFrame::Kind::Keyframe:
            chain.tier->begin(source, hash);
            break;
        case codec::EncodedFrame::Kind::Delta:
            chain.tier->next(source, hash);
            break;
        case codec::EncodedFrame::Kind::Resync:
            chain.tier->join(hash);
            break;
    }
    device_.endTimer();
    if (kind != codec::EncodedFrame::Kind::Delta) chain.keyframe = now;
    chain.turn = ++turns_;
    chain.kind = kind;
    chain.making = std::move(head);
}

void Chains::collect(const codec::Rendition& rendition, Chain& chain) {
    if (!chain.making) return;
    const auto bytes = chain.tier->poll();
    if (!bytes) return;
    v1::ServerMessage message;
    v1::Frame& made = *message.mutable_frame();
    made = std::move(*chain.making);
    chain.making.reset();
    made.set_sequence(++sequence_);
    made.set_stamp_us(microsecondsNow());
    made.set_spb(bytes->data(), bytes->size());
    publish_({rendition, chain.kind, chain.tier->number(), codec::share(std::move(message))});
}

std::optional<Chains::Clock::time_point> Chains::due() const {
    std::optional<Clock::time_point> first;
    for (const auto& [rendition, chain] : chains_) {
        if (!chain.making && chain.version == version_) continue;
        const auto when = chain.making ? Clock::now() + copyWait : chain.next;
        first = std::min(first.value_or(when), when);
    }
    return first;
}

}  // namespace spherule::app
