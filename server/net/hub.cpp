#include "net/hub.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

SessionId Hub::add(std::shared_ptr<Subscriber> session) {
    const std::lock_guard lock(mutex_);
    if (draining_) session->drain();
    entries_.emplace(++lastId_, Entry{.session = std::move(session)});
    return lastId_;
}

void Hub::remove(SessionId id) {
    const std::lock_guard lock(mutex_);
    entries_.erase(id);
    countViewers();
    if (entries_.empty()) emptied_.notify_all();
}

Hub::Entry* Hub::find(SessionId id) {
    const auto found = entries_.find(id);
    return found == entries_.end() ? nullptr : &found->second;
}

bool Hub::isAmong(const Entry& entry, codec::Audience audience) {
    return audience == codec::Audience::Everybody || entry.follows == (audience == codec::Audience::Followers);
}

void Hub::sendScene(Entry& entry) {
    const SceneState& scene = sceneFor(entry);
    if (!scene.facts) return;
    entry.session->send(scene.facts);
    for (const auto& change : scene.changes) entry.session->send(change);
}

void Hub::resendScene(SessionId id) {
    const std::lock_guard lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return;
    sendScene(*entry);
    // A queued order now comes before the facts, and the client has ignored it.
    const codec::SharedMessage& order = sceneFor(*entry).order;
    if (entry->rendition.rate > 0 && order) entry->session->send(order);
}

void Hub::join(SessionId id, const std::string& client, bool followsPopulation) {
    const std::lock_guard lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return;
    entry->joined = true;
    entry->client = client;
    entry->follows = followsPopulation;
    sendScene(*entry);
    for (const auto& [kind, message] : retained_) entry->session->send(message);
}

void Hub::subscribe(SessionId id, const codec::Rendition& rendition) {
    const std::lock_guard lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return;
    const codec::SharedMessage& order = sceneFor(*entry).order;
    if (entry->rendition.rate == 0 && rendition.rate > 0 && order) entry->session->send(order);
    entry->rendition = rendition;
    entry->newcomer = rendition.rate > 0;
    entry->lost = false;
    countViewers();
}

void Hub::requestKeyframe(SessionId id) {
    const std::lock_guard lock(mutex_);
    if (Entry* const entry = find(id)) entry->lost = entry->rendition.rate > 0;
}

void Hub::setOrder(codec::SharedMessage order, codec::Audience audience) {
    const std::lock_guard lock(mutex_);
    if (audience != codec::Audience::Others) followers_.order = order;
    if (audience != codec::Audience::Followers) others_.order = order;
    for (const auto& [id, entry] : entries_)
        if (entry.rendition.rate > 0 && isAmong(entry, audience)) entry.session->send(order);
}

void Hub::follow(codec::SharedMessage population) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_)
        if (entry.joined && entry.follows) entry.session->send(population);
    followers_.changes.push_back(std::move(population));
}

void Hub::refreshScene(codec::SharedMessage scene) {
    const std::lock_guard lock(mutex_);
    followers_.facts = std::move(scene);
    followers_.changes.clear();
}

void Hub::retain(codec::SharedMessage message, codec::Audience audience) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_) {
        if (entry.joined && isAmong(entry, audience)) entry.session->send(message);
    }
    if (!message->content().has_scene()) {
        retained_[message->content().kind_case()] = std::move(message);
        return;
    }
    // The order belongs to the previous scene.
    if (audience != codec::Audience::Others) followers_ = {.facts = message, .order = {}, .changes = {}};
    if (audience != codec::Audience::Followers) others_ = {.facts = message, .order = {}, .changes = {}};
}

void Hub::publish(const codec::EncodedFrame& encoded) {
    const std::lock_guard lock(mutex_);
    for (auto& [id, entry] : entries_) {
        if (entry.rendition.rate == 0 || entry.rendition != encoded.rendition) continue;
        const bool waits = entry.newcomer || entry.lost;
        if (encoded.kind == codec::EncodedFrame::Kind::Resync && !waits) continue;
        if (encoded.kind != codec::EncodedFrame::Kind::Delta) entry.newcomer = entry.lost = false;
        if (encoded.kind != codec::EncodedFrame::Kind::Delta || !waits) entry.session->offer(encoded);
    }
}

std::vector<codec::Subscription> Hub::subscriptions() {
    const std::lock_guard lock(mutex_);
    std::vector<codec::Subscription> subscriptions;
    for (const auto& [id, entry] : entries_) {
        if (entry.rendition.rate == 0) continue;
        auto same = std::ranges::find(subscriptions, entry.rendition, &codec::Subscription::rendition);
        if (same == subscriptions.end())
            same = subscriptions.insert(subscriptions.end(), codec::Subscription{.rendition = entry.rendition});
        same->newcomer = same->newcomer || entry.newcomer;
        same->lost = same->lost || entry.lost;
    }
    return subscriptions;
}

void Hub::broadcast(const codec::SharedMessage& message) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_) {
        if (entry.joined) entry.session->send(message);
    }
}

void Hub::announce(SessionId by, v1::Event event) {
    const std::lock_guard lock(mutex_);
    event.mutable_by()->set_session(by);
    if (const Entry* const sender = find(by)) event.mutable_by()->set_client(sender->client);
    v1::ServerMessage message;
    *message.mutable_event() = std::move(event);
    const auto shared = codec::share(std::move(message));
    for (const auto& [id, entry] : entries_)
        if (entry.joined && id != by) entry.session->send(shared);
}

void Hub::sendTo(SessionId id, codec::SharedMessage message) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    if (found != entries_.end()) found->second.session->send(std::move(message));
}

void Hub::drain() {
    const std::lock_guard lock(mutex_);
    draining_ = true;
    for (const auto& [id, entry] : entries_) entry.session->drain();
}

void Hub::dropAll() {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_) entry.session->drop();
}

bool Hub::waitEmpty(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    return emptied_.wait_for(lock, timeout, [this] { return entries_.empty(); });
}

void Hub::countViewers() {
    viewers_ = static_cast<std::uint32_t>(
        std::ranges::count_if(entries_, [](const auto& entry) { return entry.second.rendition.rate > 0; }));
}

}  // namespace spherule::net
