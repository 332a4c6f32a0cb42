#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "scene/drive.h"
#include "scene/frame.h"

namespace spherule::v1 {
class Motion;
}

namespace spherule::scene {

// A part of a motion at time t is amplitude * s, and a rotation by swing * s, where
// s = sin(2 pi frequency t + phase) - sin(phase).
struct Oscillation {
    glm::dvec3 amplitude{};  // m
    glm::dvec3 swing{};      // rad: along the axis
    double frequency = 1;    // Hz
    double phase = 0;        // degrees
};

struct Keyframe {
    double time = 0;           // s since the begin of the motion, above 0
    glm::dvec3 translation{};  // m
    Rotation rotation{};
};

// The place of a body that moves, relative to its place in the scene: it is turned about the pivot, then moved.
struct Pose {
    glm::dquat turn{1, 0, 0, 0};
    glm::dvec3 pivot{};  // m
    glm::dvec3 shift{};  // m

    // Returns it as coordinates in the scene that are turned and moved.
    [[nodiscard]] Frame frame() const;
};

// The largest speeds of a motion at any time.
struct MotionSpeeds {
    double pivot = 0;         // m/s
    double turn = 0;          // rad/s
    double acceleration = 0;  // m/s^2, of the pivot, without the jumps between keyframes

    // Returns the largest speed of a point at this distance from the pivot (m/s).
    [[nodiscard]] double at(double distance) const { return pivot + turn * distance; }
};

// The motion of an obstacle: a function of the simulated time, except with a drive. See v1::Motion.
struct Motion {
    glm::dvec3 velocity{};      // m/s
    glm::dvec3 acceleration{};  // m/s^2
    glm::dvec3 spin{};          // rad/s
    glm::dvec3 pivot{};         // m
    std::vector<Oscillation> oscillations{};
    std::vector<Keyframe> keyframes{};
    bool repeat = false;
    glm::dvec3 belt{};  // m/s, in the coordinates of the obstacle's place in the scene
    double begin = 0;   // s
    double duration = std::numeric_limits<double>::infinity();  // s
    std::optional<Drive> drive{};                               // then nothing but the belt moves it otherwise

    // Returns the pose; with a drive, the one at which it would be if no force changed its rate.
    [[nodiscard]] Pose poseAt(double time) const;
    [[nodiscard]] MotionSpeeds speeds() const;
    // Returns true if only the belt moves.
    [[nodiscard]] bool staysInPlace() const;
    [[nodiscard]] bool runsBetween(double from, double to) const { return to > begin && from < begin + duration; }
};

constexpr int maxOscillations = 4;
constexpr int maxKeyframes = 1000;

// `pivot`: for a motion without one (m).
Motion readMotion(Check& check, const v1::Motion& message, const glm::dvec3& pivot, const std::string& field);
void writeMotion(v1::Motion& message, const Motion& motion);

}  // namespace spherule::scene
