#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "record_bytes.h"
#include "recording/recording.h"
#include "recording/writer.h"
#include "temporary_folder.h"

namespace spherule::recording {

using support::TemporaryFolder;

using Positions = std::vector<glm::dvec3>;  // by id, m

// The content of a small recording: 70 spheres of two radii, a frame every 0.1 s, keyframes with frames 0, 5, 10, ...
struct Film {
    static constexpr std::uint32_t spheres = 70;
    static constexpr double quantum = 0.125;  // m
    static constexpr double interval = 0.1;   // s
    static constexpr std::uint32_t fileId = 1;
    std::vector<Positions> frames;
    std::vector<std::string> records;  // as in the file, without the index
};

// Writes the recording to `path`. `finish`: with index and trailer. `fileId`: in films of other ids the same spheres
// move otherwise.
Film film(const std::string& path, std::uint32_t frames, bool finish = true, std::uint32_t fileId = Film::fileId);

// Writes a film in which each two frames have the same time, as when the simulation was paused.
void filmWithRepeatedTimes(const std::string& path);

// Writes a film of 12 frames with two unit cubes as obstacles: the first is at rest, the second moves.
void filmWithObstacles(const std::string& path);
// The pose of the second cube in frame n.
v1::Pose poseInFilm(std::uint32_t n);

// Scene facts and order of a valid scene.
v1::ServerMessage sceneMessage(std::uint32_t epoch, std::uint32_t spheres);
v1::ServerMessage orderMessage(std::uint32_t epoch, std::uint32_t spheres);

// Returns the content of a file with the id of films and these records. Their checksums become right for their places.
std::string fileOf(std::string_view records);

std::string contentOf(const std::string& path);
void writeFile(const std::string& path, const std::string& content);

// Returns the remaining frames. `end`: the error that stopped it; empty at the end of the file.
std::vector<Positions> play(Recording& recording, std::string* end = nullptr);

// Largest difference of a coordinate.
double distance(const Positions& a, const Positions& b);

}  // namespace spherule::recording
