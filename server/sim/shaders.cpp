#include "sim/shaders.h"

#include "embedded/shaders.h"

namespace spherule::sim {

namespace {

class EmbeddedShaders final : public compute::SourceSet {
  public:
    [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const override {
        for (const embedded::File& file : embedded::shaders())
            if (file.path == name) return file.bytes;
        return std::nullopt;
    }
};

}  // namespace

const compute::SourceSet& shaders() {
    static const EmbeddedShaders sources;
    return sources;
}

std::vector<compute::Define> definesFor(const scene::Features& features) {
    auto define = [](const char* name, bool on) { return compute::Define{name, on ? "true" : "false"}; };
    return {
        define("GRAVITY", features.gravity),
        define("CONTACTS", features.contacts),
        define("RADII", features.radii),
        define("LEVELS", features.levels),
        define("RESTITUTION", features.restitution),
        define("MATERIALS", features.materials),
        define("FRICTION", features.friction),
        define("ROLLING", features.rolling),
        define("HERTZ", features.hertz),
        define("RESIDUAL", features.model == scene::Model::Accurate),
        define("BEFORE", features.needBefore()),
        define("WALLS", features.walls),
        define("PLANES", features.planes),
        define("BOXES", features.boxes),
        define("SLEEP", features.sleep),
    };
}

}  // namespace spherule::sim
