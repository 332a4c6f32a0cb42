#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr double tau = 2 * std::numbers::pi;

glm::dquat turnBy(const glm::dvec3& rotation) {
    const double angle = glm::length(rotation);
    return angle > 0 ? glm::angleAxis(angle, rotation / angle) : glm::dquat(1, 0, 0, 0);
}

// Returns an angle in radians about `axis`; nullopt if the rotation has another axis.
std::optional<double> angleAbout(const Rotation& rotation, const glm::dvec3& axis) {
    constexpr double same = 1e-12;
    if (rotation.degrees == 0) return 0;
    const glm::dvec3 own = glm::normalize(rotation.axis);
    if (glm::length(own - axis) < same) return glm::radians(rotation.degrees);
    if (glm::length(own + axis) < same) return -glm::radians(rotation.degrees);
    return std::nullopt;
}

// The way from one keyframe to the next.
struct Way {
    const Keyframe& from;
    const Keyframe& to;

    [[nodiscard]] double time() const { return to.time - from.time; }

    // Rotations about the same axis are added up, beyond half a turn too.
    [[nodiscard]] glm::dquat turnAt(double share) const {
        const Rotation& named = to.rotation.degrees != 0 ? to.rotation : from.rotation;
        const glm::dvec3 axis = glm::normalize(named.axis);
        const auto begin = angleAbout(from.rotation, axis);
        const auto end = angleAbout(to.rotation, axis);
        if (begin && end) return glm::angleAxis(*begin + share * (*end - *begin), axis);
        return glm::slerp(from.rotation.quaternion(), to.rotation.quaternion(), share);
    }
    // rad
    [[nodiscard]] double angle() const {
        constexpr int parts = 64;  // a part is a fifth of a radian at most
        const glm::dquat part = turnAt(1.0 / parts) * glm::conjugate(turnAt(0));
        return parts * 2 * std::atan2(glm::length(glm::dvec3(part.x, part.y, part.z)), std::abs(part.w));
    }
};

// Returns the way that ends at keyframe k.
Way wayTo(const std::vector<Keyframe>& keyframes, std::size_t k) {
    static const Keyframe start;
    return {k > 0 ? keyframes[k - 1] : start, keyframes[k]};
}

void addKeyframes(Pose& pose, const Motion& motion, double t) {
    if (motion.keyframes.empty()) return;
    const Keyframe& last = motion.keyframes.back();
    if (motion.repeat) t = std::fmod(t, last.time);
    const auto next = std::ranges::upper_bound(motion.keyframes, t, {}, &Keyframe::time);
    if (next == motion.keyframes.end()) {
        pose.shift += last.translation;
        pose.turn = last.rotation.quaternion() * pose.turn;
        return;
    }
    const Way way = wayTo(motion.keyframes, static_cast<std::size_t>(next - motion.keyframes.begin()));
    const double share = (t - way.from.time) / way.time();
    pose.shift += way.from.translation + share * (way.to.translation - way.from.translation);
    pose.turn = way.turnAt(share) * pose.turn;
}

}  // namespace

Frame Pose::frame() const {
    const glm::dmat3 matrix = glm::mat3_cast(turn);
    return {matrix, pivot + shift - matrix * pivot};
}

Pose Motion::poseAt(double time) const {
    if (drive) {
        const double place = drive->placeAt(time);
        if (drive->turns) return {.turn = glm::angleAxis(place, drive->axis), .pivot = pivot};
        return {.pivot = pivot, .shift = drive->axis * place};
    }
    const double t = std::clamp(time - begin, 0.0, duration);
    Pose pose{.turn = turnBy(spin * t), .pivot = pivot, .shift = velocity * t + acceleration * (0.5 * t * t)};
    for (const Oscillation& one : oscillations) {
        const double phase = glm::radians(one.phase);
        // Whole periods are left out, so that it is as exact after days as at the beginning.
        const double share = std::sin(tau * std::fmod(one.frequency * t, 1.0) + phase) - std::sin(phase);
        pose.shift += one.amplitude * share;
        pose.turn = turnBy(one.swing * share) * pose.turn;
    }
    addKeyframes(pose, *this, t);
    return pose;
}

MotionSpeeds Motion::speeds() const {
    if (drive) return drive->turns ? MotionSpeeds{.turn = drive->mostRate} : MotionSpeeds{.pivot = drive->mostRate};
    MotionSpeeds most{
        .pivot = glm::length(velocity), .turn = glm::length(spin), .acceleration = glm::length(acceleration)};
    if (most.acceleration > 0) most.pivot += most.acceleration * duration;
    for (const Oscillation& one : oscillations) {
        const double rate = tau * one.frequency;
        most.pivot += rate * glm::length(one.amplitude);
        most.turn += rate * glm::length(one.swing);
        most.acceleration += rate * rate * glm::length(one.amplitude);
    }
    double alongKeys = 0;
    double turnKeys = 0;
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
        const Way way = wayTo(keyframes, k);
        alongKeys = std::max(alongKeys, glm::distance(way.from.translation, way.to.translation) / way.time());
        turnKeys = std::max(turnKeys, way.angle() / way.time());
    }
    most.pivot += alongKeys;
    most.turn += turnKeys;
    return most;
}

bool Motion::staysInPlace() const {
    const glm::dvec3 none(0);
    return !drive && velocity == none && acceleration == none && spin == none && oscillations.empty() &&
           keyframes.empty();
}

namespace {

void readOscillations(Check& check, const v1::Motion& message, const std::string& field, Motion& motion) {
    constexpr double highest = 1e5;  // Hz
    if (message.oscillations_size() > maxOscillations)
        return check.refuse(at(field, "oscillations"), fmt::format("has {} entries, must have at most {}",
                                                                   message.oscillations_size(), maxOscillations));
    const auto count = static_cast<std::size_t>(message.oscillations_size());
    check.entries(at(field, "oscillations"), count, [&](std::size_t k, const std::string& here) {
        const v1::Oscillation& from = message.oscillations(static_cast<int>(k));
        motion.oscillations.push_back({.amplitude = check.vectorOr(from.amplitude(), {}, at(here, "amplitude")),
                                       .swing = check.vectorOr(from.swing(), {}, at(here, "swing")),
                                       .frequency = check.upTo(from.frequency(), highest, at(here, "frequency"), " Hz"),
                                       .phase = check.within(from.phase(), -360, 360, at(here, "phase"), "°")});
    });
}

void readKeyframes(Check& check, const v1::Motion& message, const std::string& field, Motion& motion) {
    constexpr double longest = 1e9;  // s
    if (message.keyframes_size() > maxKeyframes)
        return check.refuse(at(field, "keyframes"), fmt::format("has {} entries, must have at most {}",
                                                                message.keyframes_size(), maxKeyframes));
    double before = 0;
    const auto count = static_cast<std::size_t>(message.keyframes_size());
    check.entries(at(field, "keyframes"), count, [&](std::size_t k, const std::string& here) {
        const v1::Keyframe& from = message.keyframes(static_cast<int>(k));
        Keyframe key{.time = check.upTo(from.time(), longest, at(here, "time"), " s"),
                     .translation = check.vectorOr(from.translation(), {}, at(here, "translation"))};
        if (from.has_rotation())
            check.part([&] { key.rotation = readRotation(check, from.rotation(), at(here, "rotation")); });
        if (!(key.time > before))
            check.refuse(at(here, "time"),
                         fmt::format("is {} s, must be above {} s, the time before", key.time, before));
        before = std::max(before, key.time);
        motion.keyframes.push_back(key);
    });
    motion.repeat = message.repeat();
    if (!motion.repeat || !check.ok() || check.isDoubtful(at(field, "keyframes"))) return;
    if (motion.keyframes.empty()) return check.refuse(at(field, "repeat"), "is true without keyframes");
    const Keyframe& last = motion.keyframes.back();
    const double turned = std::fmod(last.rotation.degrees, 360);
    if (last.translation != glm::dvec3(0) || turned != 0)
        check.refuse(at(field, "repeat"),
                     "is true, but the last keyframe is not where the obstacle began: it would jump back; add a "
                     "keyframe without translation and rotation");
}

}  // namespace

Motion readMotion(Check& check, const v1::Motion& message, const glm::dvec3& pivot, const std::string& field) {
    constexpr double longest = 1e9;  // s
    Motion motion{.velocity = check.vectorOr(message.velocity(), {}, at(field, "velocity")),
                  .acceleration = check.vectorOr(message.acceleration(), {}, at(field, "acceleration")),
                  .spin = check.vectorOr(message.spin(), {}, at(field, "spin")),
                  .pivot = check.vectorOr(message.pivot(), pivot, at(field, "pivot")),
                  .belt = check.vectorOr(message.belt(), {}, at(field, "belt")),
                  .begin = check.within(message.begin(), -longest, longest, at(field, "begin"), " s")};
    if (message.has_duration()) motion.duration = check.upTo(message.duration(), longest, at(field, "duration"), " s");
    check.part([&] {
        if (glm::length(motion.acceleration) > 0 && !message.has_duration())
            check.refuse(at(field, "duration"),
                         "is missing, but `acceleration` needs one: the speed would grow for ever");
    });
    check.part([&] { readOscillations(check, message, field, motion); });
    check.part([&] { readKeyframes(check, message, field, motion); });
    if (message.has_drive())
        check.part([&] {
            if (!motion.staysInPlace() || message.begin() != 0 || message.has_duration())
                check.refuse(at(field, "drive"), "is beside a prescribed motion; only `pivot` and `belt` go with it");
            motion.drive = readDrive(check, message.drive(), motion.pivot, at(field, "drive"));
        });
    if (check.ok() && motion.staysInPlace() && glm::length(motion.belt) == 0)
        check.refuse(
            field, "moves nothing; give one of velocity, acceleration, spin, oscillations, keyframes, belt and drive");
    return motion;
}

namespace {

void writeOr(Numbers& numbers, const glm::dvec3& value, const glm::dvec3& absent = {}) {
    if (value != absent) setVector(numbers, value);
}

}  // namespace

void writeMotion(v1::Motion& message, const Motion& motion) {
    writeOr(*message.mutable_velocity(), motion.velocity);
    writeOr(*message.mutable_acceleration(), motion.acceleration);
    writeOr(*message.mutable_spin(), motion.spin);
    setVector(*message.mutable_pivot(), motion.pivot);
    writeOr(*message.mutable_belt(), motion.belt);
    for (const Oscillation& one : motion.oscillations) {
        v1::Oscillation& to = *message.add_oscillations();
        writeOr(*to.mutable_amplitude(), one.amplitude);
        writeOr(*to.mutable_swing(), one.swing);
        to.set_frequency(one.frequency);
        to.set_phase(one.phase);
    }
    for (const Keyframe& key : motion.keyframes) {
        v1::Keyframe& to = *message.add_keyframes();
        to.set_time(key.time);
        writeOr(*to.mutable_translation(), key.translation);
        if (key.rotation.degrees != 0) writeRotation(*to.mutable_rotation(), key.rotation);
    }
    message.set_repeat(motion.repeat);
    message.set_begin(motion.begin);
    if (std::isfinite(motion.duration)) message.set_duration(motion.duration);
    if (motion.drive) writeDrive(*message.mutable_drive(), *motion.drive);
}

}  // namespace spherule::scene
