#pragma once

#include <string>
#include <vector>

#include "scene/random.h"
#include "scene_support.h"

namespace spherule::scene::testing {

// A scene file whose only group reads its spheres from a file. The bounds are -1000 to 1000 m on every axis.
class SphereFile {
  public:
    // `source`: "xyz" or "lammps".
    SphereFile(std::string source, std::string name) : source_(std::move(source)), name_(std::move(name)) {}

    // Writes `text` to the file and loads the scene. `options`: of the source; `members`: of the group; both begin with
    // a comma.
    [[nodiscard]] Result<Scene> loaded(const std::string& text, const std::string& options = "",
                                       const std::string& members = "") const;

    // Returns the spheres. If the scene is refused, the test fails.
    [[nodiscard]] std::vector<Sphere> spheres(const std::string& text, const std::string& options = "",
                                              const std::string& members = "") const;

    // Returns the refusal from the name of the file on, or else of the field in the group, or "accepted".
    [[nodiscard]] std::string refusal(const std::string& text, const std::string& options = "",
                                      const std::string& members = "") const;

  private:
    std::string source_;
    std::string name_;
    TemporaryFolder folder_;
};

// Returns spheres with random places, velocities, spins and radii.
std::vector<Sphere> randomSpheres(Random& random);

// Expects the same spheres. float32 has radii, velocities and spins.
void expectEqual(const std::vector<Sphere>& read, const std::vector<Sphere>& expected);

}  // namespace spherule::scene::testing
