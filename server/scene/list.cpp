#include <spdlog/fmt/fmt.h>

#include "scene/load.h"
#include "scene/source.h"

namespace spherule::scene {

std::optional<memory::Claim> checkRoom(Check& check, const SourceInput& input, double count, std::string_view field,
                                       std::size_t besides) {
    if (count > static_cast<double>(input.room)) {
        check.refuse(std::string(field),
                     fmt::format("asks for {:.0f} spheres, but a scene holds at most {} and has room for {}", count,
                                 maxSpheres, input.room),
                     Cause::NoRoom, {.least = {}, .most = static_cast<double>(input.room)});
        return std::nullopt;
    }
    const auto spheres = static_cast<std::uint64_t>(count);
    auto claim = memory::Claim::make(std::string(field), fmt::format("{} spheres in a scene", spheres),
                                     spheres * (sizeof(Sphere) + besides));
    if (claim) return std::move(*claim);
    check.refuse(claim.error());
    return std::nullopt;
}

const RadiusDistribution& requiredRadii(Check& check, const SourceInput& input) {
    static const RadiusDistribution none;
    if (input.radii) return *input.radii;
    const std::size_t end = input.field.rfind('.');
    const std::string group = end == std::string::npos ? "" : input.field.substr(0, end);
    check.refuse(at(group, "radius"), "is missing; give one of constant, uniform, normal, logNormal, table");
    return none;
}

std::vector<Sphere> fromList(Check& check, const v1::List& list, SourceInput input, std::vector<std::size_t>& wrong) {
    std::vector<Sphere> spheres;
    const auto count = static_cast<std::size_t>(list.spheres_size());
    const auto room = checkRoom(check, input, static_cast<double>(count), at(input.field, "spheres"));
    if (!room) return spheres;
    spheres.reserve(count);
    check.entries(at(input.field, "spheres"), count, [&](std::size_t i, const std::string& field) {
        if (wrong.size() == mostWrongSpheres) return;
        const v1::Sphere& message = list.spheres(static_cast<int>(i));
        Sphere sphere;
        sphere.position = check.vector(message.position(), at(field, "position"));
        sphere.velocity = check.vectorOr(message.velocity(), input.velocity, at(field, "velocity"));
        sphere.spin = check.vectorOr(message.spin(), input.spin, at(field, "spin"));
        sphere.radius = message.has_radius()
                            ? static_cast<float>(readRadius(check, message.radius(), at(field, "radius")))
                            : requiredRadii(check, input).draw(input.random);
        spheres.push_back(sphere);
        if (!check.ok()) wrong.push_back(i);
    });
    return spheres;
}

}  // namespace spherule::scene
