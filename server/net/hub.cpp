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

void Hub::join(SessionId id) {
    const std::lock_guard lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return;
    entry->joined = true;
    for (const auto& [kind, message] : retained_) entry->session->send(message);
}

void Hub::subscribe(SessionId id, const codec::Rendition& rendition) {
    const std::lock_guard lock(mutex_);
    Entry* const entry = find(id);
    if (entry == nullptr) return;
    if (entry->rendition.rate == 0 && rendition.rate > 0 && order_) entry->session->send(order_);
    entry->rendition = rendition;
    entry->newcomer = rendition.rate > 0;
    entry->lost = false;
    countViewers();
}

void Hub::requestKeyframe(SessionId id) {
    const std::lock_guard lock(mutex_);
    if (Entry* const entry = find(id)) entry->lost = entry->rendition.rate > 0;
}

void Hub::setOrder(codec::SharedMessage order) {
    const std::lock_guard lock(mutex_);
    order_ = std::move(order);
    for (const auto& [id, entry] : entries_)
        if (entry.rendition.rate > 0) entry.session->send(order_);
}

void Hub::retain(codec::SharedMessage message) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_) {
        if (entry.joined) entry.session->send(message);
    }
    if (message->content().has_scene()) order_.reset();  // the order belongs to the previous scene
    retained_[message->content().kind_case()] = std::move(message);
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
