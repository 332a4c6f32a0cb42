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

}  // namespace spherule::sim
