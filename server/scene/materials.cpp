#include "scene/materials.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/suggestion.h"
#include "scene/group.h"

namespace spherule::scene {

namespace {

constexpr double smallestDensity = 1e-6;  // kg/m^3
constexpr double largestDensity = 1e9;    // kg/m^3
constexpr double softest = 1e-3;          // Pa
constexpr double stiffest = 1e15;

Material readValues(Check& check, const v1::Material& message, const std::string& field) {
    Material material{.name = message.name()};
    const auto read = [&](bool given, double value, double low, double high, const char* member, const char* unit,
                          double& target) {
        if (given) target = check.within(value, low, high, at(field, member), unit);
    };
    read(message.has_density(), message.density(), smallestDensity, largestDensity, "density", " kg/m^3",
         material.density);
    read(message.has_restitution(), message.restitution(), 0, 1, "restitution", "", material.restitution);
    read(message.has_friction(), message.friction(), 0, largestFriction, "friction", "", material.friction);
    read(message.has_rolling_resistance(), message.rolling_resistance(), 0, largestFriction, "rollingResistance", "",
         material.rollingResistance);
    read(message.has_spinning_resistance(), message.spinning_resistance(), 0, largestFriction, "spinningResistance", "",
         material.spinningResistance);
    read(message.has_young(), message.young(), softest, stiffest, "young", " Pa", material.young);
    read(message.has_poisson(), message.poisson(), -0.99, 0.5, "poisson", "", material.poisson);
    return material;
}

}  // namespace

Material readMaterial(Check& check, const v1::Material& message, std::span<const Material> others, bool first,
                      const std::string& field) {
    checkName(check, message.name(), at(field, "name"));
    Material material = readValues(check, message, field);
    check.part([&] {
        if (!first && material.name.empty())
            check.refuse(at(field, "name"), "is missing; only the first material may go without");
        else if (std::ranges::find(others, material.name, &Material::name) != others.end())
            check.refuse(at(field, "name"), fmt::format("is {}, the name of another material", shown(material.name)));
    });
    return material;
}

std::vector<Material> readMaterials(Check& check, const google::protobuf::RepeatedPtrField<v1::Material>& messages) {
    std::vector<Material> materials;
    const auto count = static_cast<std::size_t>(messages.size());
    if (count > maxMaterials)
        check.refuse("materials", fmt::format("has {} entries, must have at most {}", count, maxMaterials));
    else
        check.entries("materials", count, [&](std::size_t k, const std::string& field) {
            materials.push_back(readMaterial(check, messages[static_cast<int>(k)], materials, k == 0, field));
        });
    if (materials.empty()) materials.emplace_back();
    return materials;
}

namespace {

// Returns false if the name of a material is wrong or missing: any unknown name may be its name.
bool areNamesKnown(const Check& check, const std::vector<Material>& materials) {
    for (std::size_t k = 0; k < materials.size(); ++k)
        if ((k > 0 && materials[k].name.empty()) || check.isDoubtful(at(at("materials", k), "name"))) return false;
    return true;
}

}  // namespace

std::uint8_t materialNamed(Check& check, const std::string& name, const std::vector<Material>& materials,
                           std::string_view field) {
    if (name.empty()) return 0;
    const auto found = std::ranges::find(materials, name, &Material::name);
    if (found != materials.end()) return static_cast<std::uint8_t>(found - materials.begin());
    if (!areNamesKnown(check, materials)) return 0;
    std::vector<std::string> names;
    std::string known;
    for (const Material& material : materials) {
        if (material.name.empty()) continue;
        names.push_back(material.name);
        known += (known.empty() ? "" : ", ") + shown(material.name);
    }
    check.part([&] {
        check.refuse(std::string(field), fmt::format("is {}, which is no material of the scene; {}{}", shown(name),
                                                     known.empty() ? "it has none with a name" : "it has " + known,
                                                     didYouMean(name, names)));
    });
    return 0;
}

MaterialPair readPair(Check& check, const v1::MaterialPair& message, const std::vector<Material>& materials,
                      const std::string& field) {
    for (const auto& [name, member] : {std::pair(message.a(), "a"), std::pair(message.b(), "b")})
        check.part([&, &given = name, &own = member] {
            if (given.empty()) check.refuse(at(field, own), "is missing; give the name of a material");
        });
    MaterialPair pair;
    pair.a = materialNamed(check, message.a(), materials, at(field, "a"));
    pair.b = materialNamed(check, message.b(), materials, at(field, "b"));
    const auto read = [&](bool given, double value, double high, const char* member) {
        return given ? std::optional(check.within(value, 0, high, at(field, member))) : std::nullopt;
    };
    pair.restitution = read(message.has_restitution(), message.restitution(), 1, "restitution");
    pair.friction = read(message.has_friction(), message.friction(), largestFriction, "friction");
    pair.rollingResistance =
        read(message.has_rolling_resistance(), message.rolling_resistance(), largestFriction, "rollingResistance");
    pair.spinningResistance =
        read(message.has_spinning_resistance(), message.spinning_resistance(), largestFriction, "spinningResistance");
    return pair;
}

bool samePair(const MaterialPair& one, const MaterialPair& other) {
    return std::minmax(one.a, one.b) == std::minmax(other.a, other.b);
}

std::vector<MaterialPair> readPairs(Check& check, const google::protobuf::RepeatedPtrField<v1::MaterialPair>& messages,
                                    const std::vector<Material>& materials) {
    std::vector<MaterialPair> pairs;
    check.entries("pairs", static_cast<std::size_t>(messages.size()), [&](std::size_t k, const std::string& field) {
        const v1::MaterialPair& message = messages[static_cast<int>(k)];
        const MaterialPair pair = readPair(check, message, materials, field);
        const auto same = [&](const MaterialPair& other) { return samePair(other, pair); };
        if (check.ok() && std::ranges::any_of(pairs, same))
            check.refuse(field,
                         fmt::format("is of {} and {}, as an earlier one is", shown(message.a()), shown(message.b())));
        if (check.ok()) pairs.push_back(pair);
    });
    return pairs;
}

ContactParameters contactParametersBetween(const Scene& scene, std::uint8_t a, std::uint8_t b) {
    const Material& first = scene.materials[a];
    const Material& second = scene.materials[b];
    ContactParameters contact{.restitution = std::min(first.restitution, second.restitution),
                              .friction = std::sqrt(first.friction * second.friction),
                              .rollingResistance = std::sqrt(first.rollingResistance * second.rollingResistance),
                              .spinningResistance = std::sqrt(first.spinningResistance * second.spinningResistance)};
    for (const MaterialPair& pair : scene.pairs) {
        if (std::minmax(pair.a, pair.b) != std::minmax(a, b)) continue;
        contact.restitution = pair.restitution.value_or(contact.restitution);
        contact.friction = pair.friction.value_or(contact.friction);
        contact.rollingResistance = pair.rollingResistance.value_or(contact.rollingResistance);
        contact.spinningResistance = pair.spinningResistance.value_or(contact.spinningResistance);
    }
    return contact;
}

bool hasWalls(const Scene& scene) {
    for (std::size_t face = 0; face < 6; ++face)
        if (scene.bounds.walled(face)) return true;
    return false;
}

std::vector<ContactParameters> actingContactParameters(const Scene& scene) {
    std::set<std::uint8_t> spheres;
    std::set<std::uint8_t> surfaces;
    forEachSphere(scene, [&](const Sphere& sphere, double /*weight*/) {
        if (!sphere.fixed) spheres.insert(sphere.material);
        if (scene.sphereContacts) surfaces.insert(sphere.material);
    });
    if (hasWalls(scene)) surfaces.insert(scene.bounds.material);
    for (const Obstacle& obstacle : scene.obstacles) surfaces.insert(obstacle.material);
    std::vector<ContactParameters> contacts;
    for (const std::uint8_t a : spheres)
        for (const std::uint8_t b : surfaces) contacts.push_back(contactParametersBetween(scene, a, b));
    return contacts;
}

}  // namespace spherule::scene
