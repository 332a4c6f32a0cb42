#include <numbers>

#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

// The rows of a field in the parameters (shaders/shared/fields.h), except its kind.
struct FieldRows {
    glm::dvec4 place{};
    glm::dvec4 numbers{};
};

FieldRows rowsOf(const scene::Drag& drag, const glm::dvec3& /*centre*/) {
    return {.place = {0, 0, 0, 0.5 * drag.density * drag.coefficient * std::numbers::pi}};
}

// `centre`: of the bounds, to which positions on the device are relative.
FieldRows rowsOf(const scene::Attraction& attraction, const glm::dvec3& centre) {
    return {.place = glm::dvec4(attraction.centre - centre, attraction.strength),
            .numbers = {attraction.softening * attraction.softening, 0, 0, 0}};
}

void uploadFields(const ParameterSource& from, layout::Parameters& p) {
    static_assert(scene::maxFields == MOST_FIELDS);
    const glm::dvec3 centre = from.scene.bounds.centre();
    const auto& fields = from.scene.forces.fields;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        FieldRows rows = std::visit([&](const auto& field) { return rowsOf(field, centre); }, fields[k]);
        rows.numbers.w = static_cast<double>(fields[k].index()) + 1;
        p.fieldPlace[k] = glm::vec4(rows.place);
        p.fieldNumbers[k] = glm::vec4(rows.numbers);
    }
}

}  // namespace

// Forces on every sphere besides gravity and contacts.
const Module moduleFields{
    .feature = Feature::Fields,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return !scene.forces.fields.empty(); },
    .upload = uploadFields,
    .cost = {.name = "drag", .with = [](scene::Scene& scene) { scene.forces.fields = {scene::Drag{}}; }},
};

}  // namespace spherule::sim
