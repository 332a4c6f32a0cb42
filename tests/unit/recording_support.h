#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "recording/recording.h"
#include "recording/writer.h"
#include "temporary_folder.h"

namespace spherule::recording {

using support::TemporaryFolder;

using Places = std::vector<glm::dvec3>;  // by id, m

// What a small recording holds: 70 spheres of two radii, a frame every 0.1 s, keyframes with frames 0, 5, 10, ...
struct Film {
    static constexpr std::uint32_t spheres = 70;
    static constexpr double quantum = 0.125;  // m
    static constexpr double interval = 0.1;   // s
    std::vector<Places> frames;
    std::vector<std::string> records;  // as they stand in the file
};

// `path`: written there, finished or not.
Film film(const std::string& path, std::uint32_t frames, bool finish = true);

// The messages of a scene; an Error never.
v1::ServerMessage sceneMessage(std::uint32_t epoch, std::uint32_t spheres);
v1::ServerMessage orderMessage(std::uint32_t epoch, std::uint32_t spheres);

std::string contentOf(const std::string& path);
void put(const std::string& path, const std::string& content);

// Frames from now() or the first on, as far as it plays; then `end`: why no farther, empty at the end.
std::vector<Places> play(Recording& recording, std::string* end = nullptr);

// How far two are apart, on the axis where it is most.
double distance(const Places& a, const Places& b);

}  // namespace spherule::recording
