#include "net/lease.h"

namespace spherule::net {

namespace {

// Each is named to everybody: a row of strangers must not make that long.
constexpr int mostAsking = 16;

}  // namespace

bool Lease::holds(SessionId session) const {
    return state_.has_holder() && state_.holder().session() == session;
}

int Lease::asking(SessionId session) const {
    for (int k = 0; k < state_.asking_size(); ++k)
        if (state_.asking(k).session() == session) return k;
    return -1;
}

void Lease::give(SessionId session, const std::string& client) {
    const int place = asking(session);
    if (place >= 0) state_.mutable_asking()->DeleteSubrange(place, 1);
    state_.mutable_holder()->set_session(session);
    state_.mutable_holder()->set_client(client);
    tell();
}

bool Lease::take(SessionId session, const std::string& client) {
    if (holds(session)) return true;
    if (state_.has_holder()) return false;
    give(session, client);
    return true;
}

void Lease::ask(SessionId session, const std::string& client) {
    if (take(session, client) || asking(session) >= 0 || state_.asking_size() >= mostAsking) return;
    v1::Person& person = *state_.add_asking();
    person.set_session(session);
    person.set_client(client);
    tell();
}

void Lease::yield(SessionId session, SessionId to) {
    const int place = asking(session);
    if (place >= 0) {
        state_.mutable_asking()->DeleteSubrange(place, 1);
        return tell();
    }
    if (!holds(session)) return;
    const int heir = asking(to);
    if (heir >= 0) return give(to, std::string(state_.asking(heir).client()));
    if (to != 0) return;  // who no longer asks
    pass();
}

// To who has asked longest, or to nobody.
void Lease::pass() {
    if (state_.asking_size() > 0) return give(state_.asking(0).session(), std::string(state_.asking(0).client()));
    state_.clear_holder();
    tell();
}

void Lease::retain(SessionId session) {
    if (!holds(session) || state_.asking_size() == 0) return;
    state_.clear_asking();
    tell();
}

void Lease::left(SessionId session) {
    yield(session, 0);
}

}  // namespace spherule::net
