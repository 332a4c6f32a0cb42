#include "sim/emission.h"

#include <algorithm>
#include <cmath>

#include "sim/layout.h"

namespace spherule::sim {

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

// Adds the spheres that become due in the step, at most `room`. More of them are due in the next step.
void Emission::makeDue(const scene::Emitter& emitter, State& state, double begin, double end, std::size_t room) {
    if (state.choked) return;
    const double worked = emitter.workedUntil(end);
    for (std::size_t made = 0; made < room; ++made) {
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

const std::vector<Emission::Birth>& Emission::attempt(const scene::Scene& scene, double begin, double end) {
    births_.clear();
    std::size_t room = MOST_BIRTH_PLACES;
    for (State& state : emitters_) room -= std::min(room, state.waiting.size());
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        State& state = emitters_[k];
        const std::size_t waited = state.waiting.size();
        makeDue(scene.emitters[k], state, begin, end, room);
        room -= state.waiting.size() - waited;
        for (const Waiting& one : state.waiting) {
            Birth birth{.sphere = one.sphere, .emitter = static_cast<std::uint32_t>(k)};
            // They may have got other numbers since it became due.
            birth.sphere.group = scene.emitters[k].group;
            birth.sphere.material = scene.emitters[k].material;
            const glm::dvec3 place = scene.emitters[k].place(one.number, one.attempts);
            const glm::dvec3 velocity(birth.sphere.velocity);
            const scene::Body body{static_cast<double>(one.sphere.radius), scene.emitters[k].massOf(one.sphere)};
            const glm::dvec3 gained = scene.forces.accelerationAt(place, body) * one.flight;
            birth.sphere.position = place + (velocity + 0.5 * gained) * one.flight;
            birth.sphere.velocity = glm::vec3(velocity + gained);
            births_.push_back(birth);
        }
    }
    return births_;
}

void Emission::settle(const scene::Scene& scene, const std::vector<bool>& happened, double time) {
    std::size_t birth = 0;
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        State& state = emitters_[k];
        std::uint64_t born = 0;
        double mass = 0;
        const bool tried = !state.waiting.empty();
        std::erase_if(state.waiting, [&](Waiting& one) {
            if (happened[birth++]) {
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
