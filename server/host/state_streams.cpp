#include "host/state_streams.h"

#include <algorithm>
#include <utility>

#include "encode/morton.h"
#include "host/facts_message.h"
#include "host/to_proto.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;

// Sessions that do not follow the population get a new epoch at most so often.
constexpr auto renewEvery = 100ms;
constexpr auto renewWithoutViewers = 1s;
constexpr std::uint32_t mostChanges = 16;  // that a new follower gets besides the facts

}  // namespace

StateStreams::StateStreams(SimulationHost& host, net::Publisher& publisher, recording::LiveRecorder& recorder,
                           std::function<void()> published, encode::StreamEncoder::Warn warn)
    : host_(host),
      publisher_(publisher),
      recorder_(recorder),
      published_(std::move(published)),
      others_(
          host.device(),
          [this](const codec::EncodedFrame& encoded) {
              recorder_.publish(encoded);
              publish(encoded);
          },
          [this](codec::SharedMessage order) {
              recorder_.setOrder(order);
              publisher_.setOrder(std::move(order), codec::Audience::Others);
          },
          warn, framesMade_),
      followers_(
          host.device(), [this](const codec::EncodedFrame& encoded) { publish(encoded); },
          [this](codec::SharedMessage order) { publisher_.setOrder(std::move(order), codec::Audience::Followers); },
          warn, framesMade_) {}

void StateStreams::publish(const codec::EncodedFrame& encoded) {
    published_();
    publisher_.publish(encoded);
}

void StateStreams::beginWorld() {
    groupsVersion_ = host_.simulation().groupsVersion();
    othersEpoch_ = epoch_ = ++lastEpoch_;
    renewOthers();
    beginFollowers();
}

void StateStreams::produce(const Moment& moment, std::vector<codec::Subscription> subscriptions,
                           Clock::time_point now) {
    const auto rest = std::ranges::partition(
        subscriptions, [](const codec::Subscription& subscription) { return subscription.rendition.population; });
    std::vector<codec::Subscription> others(rest.begin(), rest.end());
    subscriptions.erase(rest.begin(), rest.end());
    recorder_.subscribe(others, now);
    const bool known = renewGroups(now);
    if (known) followPopulation(!subscriptions.empty(), now);
    const std::uint64_t version = host_.simulation().population().version();
    if (known && othersVersion_ != version && now >= nextRenewal_) {
        nextRenewal_ = now + (others.empty() ? Clock::duration(renewWithoutViewers) : Clock::duration(renewEvery));
        othersEpoch_ = ++lastEpoch_;
        renewOthers();
    }
    if (othersVersion_ == version) others_.update(inputOfOthers(moment), others, now);
    if (version_ == version) followers_.update(inputOfFollowers(moment), subscriptions, now);
}

Result<void> StateStreams::open(const codec::Rendition& rendition, const Moment& moment) {
    return others_.open(rendition, inputOfOthers(moment));
}

std::optional<StateStreams::Clock::time_point> StateStreams::due() const {
    const auto one = others_.due();
    const auto other = followers_.due();
    return one && other ? std::min(*one, *other) : one ? one : other;
}

// All chains of a state share its figures.
encode::FrameSource StateStreams::sourceAt(const Moment& moment) {
    encode::FrameSource source = encode::sourceOf(host_.simulation());
    const State state{moment.version, host_.simulation().time()};
    source.quantity = [this, state, compute = std::move(source.quantity)](v1::Quantity quantity) {
        if (quantity == v1::SPEED) return compute(quantity);
        if (figuresOf_ != state) figures_ = compute(quantity);
        figuresOf_ = state;
        return figures_;
    };
    return source;
}

encode::EncoderInput StateStreams::inputOfOthers(const Moment& moment) {
    sim::Simulation& simulation = host_.simulation();
    return {.source = sourceAt(moment),
            .spheres = simulation.count(),
            .smallestRadius = simulation.radii().smallest,
            .periods = simulation.scene().bounds.periods(),
            .epoch = othersEpoch_,
            .version = moment.version,
            .order =
                [&simulation] {
                    encode::CodecOrder order{.ids = encode::mortonOrder(simulation.snapshot().position), .handles = {}};
                    for (const std::uint32_t rank : order.ids)
                        order.handles.push_back(simulation.population().handleAt(rank));
                    return order;
                },
            .head = moment.head};
}

encode::EncoderInput StateStreams::inputOfFollowers(const Moment& moment) {
    sim::Simulation& simulation = host_.simulation();
    encode::EncoderInput input = inputOfOthers(moment);
    input.spheres = simulation.count() > 0 ? places_.count() : 0;
    input.epoch = epoch_;
    input.population = number_;
    input.order = [this, &simulation] {
        places_.setOrder(encode::mortonOrder(simulation.snapshot().position));
        return encode::CodecOrder{.ids = places_.order(), .handles = places_.handles(simulation.population())};
    };
    return input;
}

// Sends the facts of a new epoch to the sessions that do not follow the population, and to the recorder.
void StateStreams::renewOthers() {
    othersVersion_ = host_.simulation().population().version();
    const auto facts = codec::share(factsMessage(host_.simulation(), othersEpoch_));
    recorder_.retain(facts);
    publisher_.retain(facts, codec::Audience::Others);
}

// Tells everybody of groups and materials that have changed, in a new epoch, at most ten times a second. Returns false
// while they do not know the present ones: groups may have other numbers by then.
bool StateStreams::renewGroups(Clock::time_point now) {
    if (groupsVersion_ == host_.simulation().groupsVersion()) return true;
    if (now < nextGroups_) return false;
    nextGroups_ = now + renewEvery;
    beginWorld();
    return true;
}

// Gives the followers new places, in a new epoch.
void StateStreams::beginFollowers() {
    const sim::Simulation& simulation = host_.simulation();
    places_ = encode::Places(simulation.population());
    number_ = inFacts_ = 0;
    groups_ = simulation.scene().groups.size();
    version_ = simulation.population().version();
    publisher_.retain(codec::share(factsMessage(simulation, epoch_, places_, 0)), codec::Audience::Followers);
}

// Tells the followers which spheres were added and removed. An empty world has no frames, with which changes take
// effect, so it begins an epoch. `watched`: some followers want frames.
void StateStreams::followPopulation(bool watched, Clock::time_point now) {
    sim::Simulation& simulation = host_.simulation();
    const sim::Population& population = simulation.population();
    if (population.version() == version_) return;
    std::optional<encode::Places::Change> change;
    const bool hasOrder = followers_.hasOrder(epoch_, encode::sourceOf(simulation));
    if (hasOrder && population.count() > 0) change = places_.follow(population);
    if (!change) {
        if (!watched && now < nextBegin_) return;
        nextBegin_ = now + renewWithoutViewers;
        epoch_ = ++lastEpoch_;
        return beginFollowers();
    }
    version_ = population.version();
    followers_.setHandles(places_.handles(population));
    v1::ServerMessage message = populationMessage(simulation, *change, groups_);
    message.mutable_population()->set_epoch(epoch_);
    message.mutable_population()->set_number(++number_);
    groups_ = simulation.scene().groups.size();
    publisher_.follow(codec::share(std::move(message)));
    if (number_ - inFacts_ < mostChanges) return;
    inFacts_ = number_;
    publisher_.refreshScene(codec::share(factsMessage(simulation, epoch_, places_, number_)));
}

}  // namespace spherule::host
