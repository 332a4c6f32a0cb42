#include <cstring>
#include <fstream>
#include <stdexcept>

#include "trajectories.h"

// A binary dump in the byte order of this machine. For each trajectory: name, sizes and frames.
namespace spherule::bench {

namespace {

struct Head {
    char name[16];
    std::uint64_t spheres;
    std::uint64_t frames;
    double smallestRadius;
};

}  // namespace

void save(const std::string& path, const std::vector<Trajectory>& trajectories) {
    std::ofstream file(path, std::ios::binary);
    for (const Trajectory& trajectory : trajectories) {
        Head head{.name = {},
                  .spheres = trajectory.spheres,
                  .frames = trajectory.frames.size(),
                  .smallestRadius = trajectory.smallestRadius};
        trajectory.name.copy(head.name, sizeof head.name - 1);
        file.write(reinterpret_cast<const char*>(&head), sizeof head);
        for (const auto& frame : trajectory.frames) {
            file.write(reinterpret_cast<const char*>(frame.data()),
                       static_cast<std::streamsize>(frame.size() * sizeof frame[0]));
        }
    }
    if (!file) throw std::runtime_error("cannot write " + path);
}

std::vector<Trajectory> load(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::vector<Trajectory> trajectories;
    Head head{};
    while (file.read(reinterpret_cast<char*>(&head), sizeof head)) {
        Trajectory trajectory{.name = head.name,
                              .spheres = static_cast<std::uint32_t>(head.spheres),
                              .smallestRadius = head.smallestRadius,
                              .frames = {}};
        for (std::uint64_t k = 0; k < head.frames; ++k) {
            auto& frame = trajectory.frames.emplace_back(head.spheres);
            file.read(reinterpret_cast<char*>(frame.data()),
                      static_cast<std::streamsize>(frame.size() * sizeof frame[0]));
        }
        if (!file) throw std::runtime_error(path + " ends too early");
        trajectories.push_back(std::move(trajectory));
    }
    return trajectories;
}

}  // namespace spherule::bench
