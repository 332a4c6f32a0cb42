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

void Hub::join(SessionId id, std::uint32_t rate) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end()) return;
    Entry& entry = found->second;
    entry.joined = true;
    entry.rate = rate;
    countViewers();
    if (rate > 0) ++joins_;
    if (scene_) entry.session->send(scene_);
    if (settings_) entry.session->send(settings_);
    if (dial_) entry.session->send(dial_);
    if (rate > 0 && latest_) entry.session->offer(latest_);
}

void Hub::setScene(frame::SharedMessage facts) {
    keep(scene_, std::move(facts));
}

void Hub::setSettings(frame::SharedMessage settings) {
    keep(settings_, std::move(settings));
}

void Hub::setDial(frame::SharedMessage dial) {
    keep(dial_, std::move(dial));
}

// For newcomers, too.
void Hub::keep(frame::SharedMessage& kept, frame::SharedMessage message) {
    const std::lock_guard lock(mutex_);
    kept = std::move(message);
    for (const auto& [id, entry] : entries_) {
        if (entry.joined) entry.session->send(kept);
    }
}

void Hub::publish(frame::SharedMessage state) {
    const std::lock_guard lock(mutex_);
    if (viewers_ == 0) return;
    latest_ = std::move(state);
    for (const auto& [id, entry] : entries_) {
        if (entry.rate > 0) entry.session->offer(latest_);
    }
}

void Hub::broadcast(const frame::SharedMessage& message) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_) {
        if (entry.joined) entry.session->send(message);
    }
}

void Hub::sendTo(SessionId id, frame::SharedMessage message) {
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
    std::uint32_t viewers = 0;
    std::uint32_t rate = 0;
    for (const auto& [id, entry] : entries_) {
        if (entry.rate > 0) ++viewers;
        rate = std::max(rate, entry.rate);
    }
    viewers_ = viewers;
    rate_ = rate;
    if (viewers == 0) latest_.reset();
}

}  // namespace spherule::net
