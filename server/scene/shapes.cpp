#include "scene/shapes.h"

#include <algorithm>
#include <array>

#include <spdlog/fmt/fmt.h>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr std::array types = {
#define SHAPE(flag, Name, text, number, function) &shapes##Name,
#include "shapes.def"
#undef SHAPE
};

// Kernels have the numbers, and C++ counts.
#define SHAPE(flag, Name, text, number, function) static_assert(static_cast<unsigned>(ShapeKind::Name) == (number));
#include "shapes.def"
#undef SHAPE

std::string fieldNames() {
    const auto* const shapes = v1::Obstacle::descriptor()->FindOneofByName("shape");
    std::string names = shapes->field(0)->name();
    for (int k = 1; k < shapes->field_count(); ++k) names += ", " + shapes->field(k)->name();
    return names;
}

}  // namespace

ShapePointer readShape(Check& check, const v1::Obstacle& message, const std::string& field) {
    for (const ShapeType* type : types)
        if (type->field == message.shape_case()) return type->read(check, message, field);
    check.refuse(field, fmt::format("has no shape, must have one of {}", fieldNames()));
    return nullptr;
}

std::uint32_t surfacesOf(const Scene& scene) {
    std::uint32_t surfaces = faceCount;
    for (const Obstacle& obstacle : scene.obstacles) surfaces += obstacle.shape->parts();
    return surfaces;
}

ShapePointer exampleOf(ShapeKind kind, double top) {
    return types.at(static_cast<std::size_t>(kind))->example(top);
}

}  // namespace spherule::scene
