#include "net/control_lock.h"

namespace spherule::net {

namespace {

// Bounds the control message, which lists all requests and is sent to every session.
constexpr int maxRequests = 16;

}  // namespace

bool ControlLock::holds(SessionId session) const {
    return state_.has_holder() && state_.holder().session() == session;
}

int ControlLock::requestIndex(SessionId session) const {
    for (int k = 0; k < state_.asking_size(); ++k)
        if (state_.asking(k).session() == session) return k;
    return -1;
}

void ControlLock::grant(SessionId session, const std::string& client) {
    const int index = requestIndex(session);
    if (index >= 0) state_.mutable_asking()->DeleteSubrange(index, 1);
    state_.mutable_holder()->set_session(session);
    state_.mutable_holder()->set_client(client);
    notify();
}

bool ControlLock::acquire(SessionId session, const std::string& client) {
    if (holds(session)) return true;
    if (state_.has_holder()) return false;
    grant(session, client);
    return true;
}

void ControlLock::request(SessionId session, const std::string& client) {
    if (acquire(session, client) || requestIndex(session) >= 0 || state_.asking_size() >= maxRequests) return;
    v1::Person& person = *state_.add_asking();
    person.set_session(session);
    person.set_client(client);
    notify();
}

void ControlLock::release(SessionId session, SessionId to) {
    const int index = requestIndex(session);
    if (index >= 0) {
        state_.mutable_asking()->DeleteSubrange(index, 1);
        return notify();
    }
    if (!holds(session)) return;
    const int next = requestIndex(to);
    if (next >= 0) return grant(to, std::string(state_.asking(next).client()));
    if (to != 0) return;  // that request has been withdrawn
    passOn();
}

// Passes the lock to the oldest request; frees it if there is none.
void ControlLock::passOn() {
    if (state_.asking_size() > 0) return grant(state_.asking(0).session(), std::string(state_.asking(0).client()));
    state_.clear_holder();
    notify();
}

void ControlLock::denyRequests(SessionId session) {
    if (!holds(session) || state_.asking_size() == 0) return;
    state_.clear_asking();
    notify();
}

void ControlLock::onSessionEnded(SessionId session) {
    release(session, 0);
}

}  // namespace spherule::net
