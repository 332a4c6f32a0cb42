#include "host/requests.h"

#include <utility>

namespace spherule::host {

Requests::Refusal Requests::push(Request request) {
    const std::lock_guard lock(mutex_);
    if (request.command.has_query() || request.command.has_inspect()) {
        std::size_t& waiting = queriesOf_[request.session];
        if (waiting >= limits_.queriesPerSession)
            return "as many queries of this client wait as may: send the next when one has been answered";
        ++waiting;
        queries_.push_back(std::move(request));
    } else {
        if (auto reason = refusesLocked(request.session, request.bytes)) return reason;
        if (request.command.has_pull()) pulling_.insert(request.session);
        addLocked(std::move(request));
    }
    ready_.notify_one();
    return std::nullopt;
}

void Requests::addLocked(Request request) {
    Row& row = rows_[request.session];
    ++commands_;
    bytes_ += request.bytes;
    row.bytes += request.bytes;
    row.waiting.push_back(std::move(request));
}

void Requests::release(std::uint64_t session) {
    const std::lock_guard lock(mutex_);
    if (pulling_.erase(session) == 0) return;
    Request request;
    request.session = session;
    request.answered = false;
    request.command.mutable_release();
    addLocked(std::move(request));
    ready_.notify_one();
}

Requests::Refusal Requests::refuses(std::uint64_t session, std::size_t bytes) const {
    const std::lock_guard lock(mutex_);
    return refusesLocked(session, bytes);
}

Requests::Refusal Requests::refusesLocked(std::uint64_t session, std::size_t bytes) const {
    if (commands_ >= limits_.commands || bytes_ + bytes > limits_.bytes) return "the command queue is full";
    const auto row = rows_.find(session);
    if (row != rows_.end() && (row->second.waiting.size() >= limits_.commandsPerSession ||
                               row->second.bytes + bytes > limits_.bytesPerSession))
        return "as many commands of this client wait as may: send the next when one has been answered";
    return std::nullopt;
}

std::optional<Request> Requests::tryPop() {
    const std::lock_guard lock(mutex_);
    return popLocked();
}

std::optional<Request> Requests::popFor(std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    ready_.wait_for(lock, timeout, [this] { return commands_ > 0 || !queries_.empty(); });
    return popLocked();
}

std::vector<Request> Requests::takeQueries() {
    const std::lock_guard lock(mutex_);
    queriesOf_.clear();
    return std::exchange(queries_, {});
}

// Takes a command of the session after the one that was served last.
std::optional<Request> Requests::popLocked() {
    if (rows_.empty()) return std::nullopt;
    auto place = rows_.upper_bound(last_);
    if (place == rows_.end()) place = rows_.begin();
    Row& row = place->second;
    Request request = std::move(row.waiting.front());
    row.waiting.pop_front();
    row.bytes -= request.bytes;
    bytes_ -= request.bytes;
    --commands_;
    last_ = place->first;
    if (row.waiting.empty()) rows_.erase(place);
    return request;
}

}  // namespace spherule::host
