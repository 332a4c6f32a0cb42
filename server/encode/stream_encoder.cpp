#include "encode/stream_encoder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "codec/order.h"
#include "sim/pass.h"

namespace spherule::encode {

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

StreamEncoder::StreamEncoder(compute::Device& device, Publish publish, PublishOrder publishOrder, Warn warn,
                             std::uint64_t& sequence)
    : device_(device),
      publish_(std::move(publish)),
      publishOrder_(std::move(publishOrder)),
      warn_(std::move(warn)),
      sequence_(sequence) {}

void StreamEncoder::update(const EncoderInput& input, const std::vector<codec::Subscription>& subscriptions,
                           Clock::time_point now) {
    if (input.epoch != epoch_) chains_.clear();
    version_ = input.version;
    std::erase_if(chains_, [&](const auto& entry) {
        return std::ranges::find(subscriptions, entry.first, &codec::Subscription::rendition) == subscriptions.end();
    });
    if (input.spheres == 0) return;
    for (auto& [rendition, chain] : chains_) collect(rendition, chain);
    std::vector<std::pair<codec::Rendition, Chain*>> underWay;
    for (const codec::Subscription& subscription : subscriptions) {
        Chain* const chain = chainFor(subscription, input, now);
        if (chain == nullptr) continue;
        if (!chain->inProgress) begin(subscription, *chain, input, now);
        if (chain->inProgress) underWay.emplace_back(subscription.rendition, chain);
    }
    // The device copies only a few frames at a time, so the oldest goes first.
    std::ranges::sort(underWay, {}, [](const auto& entry) { return entry.second->startedAt; });
    for (const auto& [rendition, chain] : underWay) collect(rendition, *chain);
}

StreamEncoder::Chain* StreamEncoder::chainFor(const codec::Subscription& subscription, const EncoderInput& input,
                                              Clock::time_point now) {
    if (!chains_.contains(subscription.rendition) && now < retry_ && input.epoch == refusedEpoch_) return nullptr;
    auto chain = chainOf(subscription.rendition, input);
    if (chain) return *chain;
    warn_(fmt::format("Viewers of {} at {}/s get no frames: {}.", v1::Tier_Name(subscription.rendition.tier),
                      subscription.rendition.rate, chain.error().text()));
    retry_ = now + retryEvery;
    refusedEpoch_ = input.epoch;
    return nullptr;
}

Result<void> StreamEncoder::open(const codec::Rendition& rendition, const EncoderInput& input) {
    if (input.epoch != epoch_) chains_.clear();
    if (input.spheres == 0) return {};
    auto chain = chainOf(rendition, input);
    if (!chain) return tl::unexpected(chain.error());
    return {};
}

Result<void> StreamEncoder::prepare(const EncoderInput& input) {
    const bool slots = input.source.slotOf != nullptr;
    if (!context_ || context_->spheres() != input.spheres || slots_ != slots) {
        auto kernels = context_ && slots_ == slots ? context_->kernels() : nullptr;
        context_.reset();
        auto made = EncoderContext::create(device_, input.spheres, slots, std::move(kernels));
        if (!made) return tl::unexpected(made.error());
        context_ = std::move(*made);
        slots_ = slots;
    }
    const CodecOrder order = input.order();
    context_->setOrder(order.handles);
    epoch_ = input.epoch;
    v1::ServerMessage message;
    *message.mutable_order() = codec::orderMessage(epoch_, ++order_, order.ids);
    publishOrder_(codec::share(std::move(message)));
    return {};
}

Result<StreamEncoder::Chain*> StreamEncoder::chainOf(const codec::Rendition& rendition, const EncoderInput& input) {
    if (const auto known = chains_.find(rendition); known != chains_.end()) return &known->second;
    if (input.epoch != epoch_)
        if (auto done = prepare(input); !done) return tl::unexpected(done.error());
    auto encoder = FrameEncoder::create(*context_, rendition.tier, input.smallestRadius, input.periods, rendition.turns,
                                        input.source.quantity ? rendition.quantity : v1::QUANTITY_UNSPECIFIED,
                                        rendition.spins && input.source.spins != nullptr);
    if (!encoder) return tl::unexpected(encoder.error());
    Chain& chain = chains_[rendition];
    chain.encoder = std::move(*encoder);
    return &chain;
}

// In a slow world the next frame is always due. Then keyframes for waiting viewers and frames for all viewers
// alternate.
void StreamEncoder::begin(const codec::Subscription& subscription, Chain& chain, const EncoderInput& input,
                          Clock::time_point now) {
    using enum codec::EncodedFrame::Kind;
    const bool begun = chain.encoder->number() > 0;
    const bool due = now >= chain.next && chain.version != input.version;
    const auto since = now - chain.keyframe;
    const bool waits =
        begun && ((subscription.newcomer && since >= newcomersEvery) || (subscription.lost && since >= keyframesEvery));
    if (waits && (!due || chain.kind == Delta)) return start(chain, Resync, chain.newest, input.source, now);
    if (begun && !due) return;
    const auto interval = std::chrono::duration_cast<Clock::duration>(1s) / subscription.rendition.rate;
    chain.next = std::max(chain.next + interval, now - interval / 2);
    chain.version = input.version;
    chain.newest = input.head();
    chain.newest.set_epoch(epoch_);
    chain.newest.set_order(order_);
    chain.newest.set_count(input.spheres);
    chain.newest.set_population(input.population);
    chain.newest.set_tier(subscription.rendition.tier);
    start(chain, begun ? Delta : Keyframe, chain.newest, input.source, now);
}

void StreamEncoder::start(Chain& chain, codec::EncodedFrame::Kind kind, v1::Frame head, const FrameSource& source,
                          Clock::time_point now) {
    const bool hash = now - chain.hash >= hashEvery;
    if (hash) chain.hash = now;
    device_.beginTimer(static_cast<unsigned>(sim::Pass::Pack));
    switch (kind) {
        case codec::EncodedFrame::Kind::Keyframe:
            chain.encoder->encodeKeyframe(source, hash);
            break;
        case codec::EncodedFrame::Kind::Delta:
            chain.encoder->encodeDelta(source, hash);
            break;
        case codec::EncodedFrame::Kind::Resync:
            chain.encoder->encodeResync(hash);
            break;
    }
    device_.endTimer();
    if (kind != codec::EncodedFrame::Kind::Delta) chain.keyframe = now;
    chain.startedAt = ++starts_;
    chain.kind = kind;
    chain.inProgress = std::move(head);
}

void StreamEncoder::collect(const codec::Rendition& rendition, Chain& chain) {
    if (!chain.inProgress) return;
    if (!chain.encoder->poll(*chain.inProgress)) return;
    v1::ServerMessage message;
    v1::Frame& made = *message.mutable_frame();
    made = std::move(*chain.inProgress);
    chain.inProgress.reset();
    made.set_sequence(++sequence_);
    made.set_stamp_us(microsecondsNow());
    publish_({rendition, chain.kind, chain.encoder->number(), codec::share(std::move(message))});
}

std::optional<StreamEncoder::Clock::time_point> StreamEncoder::due() const {
    std::optional<Clock::time_point> first;
    for (const auto& [rendition, chain] : chains_) {
        if (!chain.inProgress && chain.version == version_) continue;
        const auto when = chain.inProgress ? Clock::now() + copyWait : chain.next;
        first = std::min(first.value_or(when), when);
    }
    return first;
}

}  // namespace spherule::encode
