#include "sim/emission.h"

#include <algorithm>
#include <cmath>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

// Returns the largest number of places that each may get, if nobody gets more than they want and all together get at
// most `room`.
std::size_t fairShare(std::vector<std::size_t> wanted, std::size_t room) {
    std::ranges::sort(wanted);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const std::size_t each = room / (wanted.size() - k);
        if (wanted[k] > each) return each;
        room -= wanted[k];
    }
    return wanted.empty() ? 0 : wanted.back();
}

}  // namespace

Emission::Emission(const scene::Scene& scene, double time) {
    for (const scene::Emitter& emitter : scene.emitters) add(emitter, time);
}

void Emission::add(const scene::Emitter& emitter, double time) {
    startAt(emitters_.emplace_back(), emitter, time);
}

void Emission::replace(std::size_t number, const scene::Emitter& emitter, double time) {
    emitters_[number].waiting.clear();
    emitters_[number].chokedFrom.reset();
    emitters_[number].choked = false;
    startAt(emitters_[number], emitter, time);
}

void Emission::remove(std::size_t number) {
    emitters_.erase(emitters_.begin() + static_cast<std::ptrdiff_t>(number));
}

bool Emission::hasEnded(const scene::Emitter& emitter, const State& state) {
    return state.choked || (emitter.total && state.born.spheres() >= *emitter.total);
}

// Spheres that were due before `time` are not made.
void Emission::startAt(State& state, const scene::Emitter& emitter, double time) {
    const double worked = emitter.workedUntil(time);
    state.next = static_cast<std::uint64_t>(std::ceil(worked * emitter.rate));
    state.massDue = worked * emitter.massFlow;
}

// Adds the spheres that become due in the step, at most MOST_BIRTH_PLACES. More of them are due in the next step.
void Emission::makeDue(const scene::Emitter& emitter, State& state, double begin, double end) {
    if (state.choked) return;
    const double worked = emitter.workedUntil(end);
    for (std::size_t made = 0; made < MOST_BIRTH_PLACES; ++made) {
        if (emitter.total && state.born.spheres() + state.waiting.size() >= *emitter.total) return;
        const double due = emitter.rate > 0 ? static_cast<double>(state.next) / emitter.rate
                                            : state.massDue / emitter.massFlow;  // s of work
        if (!(due < worked)) return;
        Waiting one{.sphere = emitter.sphere(state.next), .number = state.next};
        one.flight = std::clamp(end - emitter.timeAfter(due), 0.0, end - begin);
        state.massDue += emitter.massOf(one.sphere);
        ++state.next;
        state.waiting.push_back(one);
    }
}

// Chooses the spheres to attempt: first among those that have become due in this step, then among the others.
void Emission::choose() {
    std::size_t room = MOST_BIRTH_PLACES;
    for (const bool fresh : {true, false}) {
        const auto isOne = [fresh](const Waiting& one) { return (one.attempts == 0) == fresh; };
        std::vector<std::size_t> wanted;
        for (const State& state : emitters_)
            wanted.push_back(static_cast<std::size_t>(std::ranges::count_if(state.waiting, isOne)));
        const std::size_t each = fairShare(wanted, room);
        for (State& state : emitters_) {
            std::size_t left = std::min(each, room);
            for (Waiting& one : state.waiting) {
                if (!isOne(one)) continue;
                one.attempted = left > 0;
                left -= one.attempted ? 1 : 0;
                room -= one.attempted ? 1 : 0;
            }
        }
    }
}

// Returns the sphere where its present attempt puts it.
scene::Sphere Emission::birthOf(const Waiting& one, const scene::Emitter& emitter, const scene::Scene& scene) {
    scene::Sphere birth = one.sphere;
    // They may have got other numbers since it became due.
    birth.group = emitter.group;
    birth.material = emitter.material;
    const glm::dvec3 place = emitter.place(one.number, one.attempts);
    const glm::dvec3 velocity(birth.velocity);
    const scene::Body body{static_cast<double>(one.sphere.radius), emitter.massOf(one.sphere)};
    const glm::dvec3 gained = scene.forces.accelerationAt(place, body) * one.flight;
    birth.position = place + (velocity + 0.5 * gained) * one.flight;
    birth.velocity = glm::vec3(velocity + gained);
    return birth;
}

const std::vector<scene::Sphere>& Emission::attempt(const scene::Scene& scene, double begin, double end) {
    for (std::size_t k = 0; k < emitters_.size(); ++k) makeDue(scene.emitters[k], emitters_[k], begin, end);
    choose();
    births_.clear();
    for (std::size_t k = 0; k < emitters_.size(); ++k)
        for (const Waiting& one : emitters_[k].waiting)
            if (one.attempted) births_.push_back(birthOf(one, scene.emitters[k], scene));
    return births_;
}

void Emission::settle(const scene::Scene& scene, const std::vector<bool>& happened, double time) {
    std::size_t birth = 0;
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        State& state = emitters_[k];
        std::uint64_t born = 0;
        double mass = 0;
        const bool tried = std::ranges::any_of(state.waiting, &Waiting::attempted);
        std::erase_if(state.waiting, [&](Waiting& one) {
            if (one.attempted && happened[birth++]) {
                ++born;
                mass += scene.emitters[k].massOf(one.sphere);
                return true;
            }
            if (++one.attempts < scene::Emitter::mostAttempts) return false;
            ++state.blocked;
            return true;
        });
        if (born > 0) state.born.add(time, born, mass);
        if (tried) followChoke(scene.emitters[k], state, born > 0, time);
    }
}

// After attempts, of which `free` tells whether one found a place.
void Emission::followChoke(const scene::Emitter& emitter, State& state, bool free, double time) {
    if (free) state.chokedFrom.reset();
    if (free || !emitter.untilChoked) return;
    const double worked = emitter.workedUntil(time);
    if (!state.chokedFrom) state.chokedFrom = worked;
    if (worked - *state.chokedFrom < *emitter.untilChoked) return;
    state.choked = true;
    state.blocked += state.waiting.size();
    state.waiting.clear();
}

Emission::Counts Emission::counts(const scene::Scene& scene, std::size_t emitter) const {
    const State& state = emitters_[emitter];
    return {.born = state.born,
            .blocked = state.blocked,
            .waiting = state.waiting.size(),
            .ended = hasEnded(scene.emitters[emitter], state)};
}

std::vector<scene::EmitterProgress> Emission::progress(const scene::Scene& scene) const {
    std::vector<scene::EmitterProgress> progress;
    for (std::size_t k = 0; k < emitters_.size(); ++k)
        progress.push_back({.born = emitters_[k].born.spheres(), .ended = hasEnded(scene.emitters[k], emitters_[k])});
    return progress;
}

}  // namespace spherule::sim
