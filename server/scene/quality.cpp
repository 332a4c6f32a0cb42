#include "scene/quality.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/load.h"
#include "scene/quality_goal.h"
#include "scene/stiffness.h"

namespace spherule::scene {

namespace {

// The limits of `accurate`. Springs with a stiffness from the materials need at least `fewestPerContact` substeps per
// contact. Springs with a stiffness from the substeps have at most this overlap at the fastest impact: with more,
// spheres pass through each other and through walls.
constexpr double fewestPerContact = 10;
constexpr double softest = 0.5;  // of the radius

constexpr std::array<std::string_view, 3> modelNames = {"fast", "balanced", "accurate"};

// h = min(1/480 s, sqrt(8.5e-4 r_min / a)) with the strongest acceleration a: keeps the mean overlap of a bed under a
// hundredth of the radius.
double balancedSubstep(const Scene& scene) {
    constexpr double longest = 1.0 / 480;
    const double acceleration = strongestAcceleration(scene);
    const double radius = smallestRadiusIn(scene);
    return acceleration > 0 && radius > 0 ? std::min(longest, std::sqrt(8.5e-4 * radius / acceleration)) : longest;
}

// Returns the fewest substeps of a step with which springs and liquids swing no sphere by more than 0.2 rad in a
// substep. Leapfrog then errs by 0.2 % in the period.
double substepsForFields(const Scene& scene) {
    constexpr double mostAngle = 0.2;
    return std::ceil(highestFieldFrequency(scene) * scene.step / mostAngle);
}

// Refuses materials so soft that spheres fall through bodies that should support them.
Result<void> checkYoung(const Scene& scene) {
    if (scene.quality.model != Model::Accurate || !followsHertz(scene)) return {};
    const auto soft = tooSoft(scene);
    if (!soft) return {};
    // Rounded up, so that the value in the message is accepted.
    const double digit = std::pow(10.0, std::floor(std::log10(soft->smallestYoung)) - 2);
    return fail(
        ErrorKind::Input, at(at("materials", soft->material), "young"),
        fmt::format("is {:.3g} Pa, so soft that spheres give way by more than half a radius under the impacts and "
                    "the weight of this scene; give at least {:.3g} Pa",
                    scene.materials[soft->material].young, std::ceil(soft->smallestYoung / digit) * digit),
        Cause::NotSuited);
}

// Returns the scene with the model, and with substeps that the model chooses.
Scene withFreeSubsteps(const Scene& scene, Model model) {
    Scene free = scene;
    free.quality.model = model;
    free.quality.substepsFixed = false;
    return free;
}

}  // namespace

double smallestRadiusIn(const Scene& scene) {
    double smallest = 0;
    forEachSphere(scene, [&](const Sphere& sphere, double /*weight*/) {
        if (smallest == 0 || static_cast<double>(sphere.radius) < smallest)
            smallest = static_cast<double>(sphere.radius);
    });
    return smallest;
}

std::string_view nameOf(Model model) {
    return modelNames.at(static_cast<std::size_t>(model));
}

std::optional<Model> modelNamed(std::string_view name) {
    const auto found = std::ranges::find(modelNames, name);
    if (found == modelNames.end()) return std::nullopt;
    return static_cast<Model>(found - modelNames.begin());
}

Model modelOf(v1::Model message) {
    return static_cast<Model>(message - v1::FAST);
}

v1::Model messageOf(Model model) {
    return static_cast<v1::Model>(static_cast<int>(model) + v1::FAST);
}

double defaultSubsteps(const Scene& scene) {
    // The rule's constant has two figures, so a substep may exceed it by a hundredth: 1/480 s at r = 0.05 m on earth.
    constexpr double slack = 0.01;
    constexpr double coarser = 4;  // `fast` needs fewer substeps by this factor
    if (scene.quality.model == Model::Accurate)
        return std::max({1.0, std::ceil(scene.step / contactTimeOf(scene).substep), substepsForFields(scene)});
    double substep = balancedSubstep(scene);
    if (scene.quality.model == Model::Fast) substep *= coarser;
    return std::max({1.0, std::ceil(scene.step / substep * (1 - slack)), substepsForFields(scene)});
}

Result<void> checkModel(const Scene& scene) {
    if (scene.quality.model == Model::Fast)
        for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
            if (scene.obstacles[k].motion && scene.obstacles[k].motion->drive)
                return fail(ErrorKind::Input, at(at("obstacles", k), "motion.drive"),
                            "needs the model balanced or accurate: fast holds no body up by its contacts",
                            Cause::NotSuited);
    if (scene.quality.model != Model::Accurate || !followsHertz(scene)) return {};
    for (std::size_t k = 0; k < scene.materials.size(); ++k)
        if (!(scene.materials[k].young > 0))
            return fail(ErrorKind::Input, at(at("materials", k), "young"),
                        "is missing; with one material's modulus given, accurate needs all of them", Cause::NotSuited);
    return {};
}

Result<void> fitSubsteps(Scene& scene) {
    Quality& quality = scene.quality;
    constexpr const char* field = "quality.substeps";
    if (auto fits = checkYoung(scene); !fits) return fits;
    if (!quality.substepsFixed) {
        const double wanted = defaultSubsteps(scene);
        if (!(wanted <= maxSubsteps))
            return fail(ErrorKind::Input, field,
                        fmt::format("would be {:.0f} for this scene, must be at most {}; shorten the step or give "
                                    "substeps",
                                    wanted, maxSubsteps),
                        Cause::TooManySubsteps, {.least = {}, .most = maxSubsteps});
        quality.substeps = static_cast<std::uint32_t>(wanted);
        return {};
    }
    const std::uint32_t most = maxSubstepsFor(scene);
    if (quality.substeps < 1 || quality.substeps > most)
        return fail(ErrorKind::Input, field,
                    fmt::format("is {}, must be 1 to {} for the {} spheres of this scene", quality.substeps, most,
                                scene.spheres.size()),
                    Cause::Range, {.least = 1, .most = most});
    const std::uint32_t fewest = minSubstepsFor(scene, quality.model);
    if (quality.substeps >= fewest) return {};
    if (quality.goal) {
        quality.substeps = fewest;  // with a goal, the number of substeps may change
        return {};
    }
    const std::string reason =
        fewest <= substepsForFields(scene)
            ? fmt::format("fields swing a sphere at {:.3g} rad/s, and a substep may take at most 0.2 rad",
                          highestFieldFrequency(scene))
        : followsHertz(scene) ? "contacts of these materials would take less than 10 substeps then"
                              : fmt::format("springs so soft would give way by {:.0f} % of a radius", 100 * softest);
    return fail(ErrorKind::Input, field,
                fmt::format("is {}, but {}; give at least {}", quality.substeps, reason, fewest), Cause::Range,
                {.least = fewest, .most = most});
}

double substepsOfTenSeconds(const Scene& scene) {
    constexpr double sphereSubsteps = 2e8;
    // The launches of a substep take as long as this number of spheres.
    constexpr double launches = 1e4;
    return sphereSubsteps / (static_cast<double>(scene.spheres.size()) + launches);
}

std::uint32_t maxSubstepsFor(const Scene& scene) {
    constexpr double timesOwn = 8;  // the largest factor that the dial offers
    // Only the springs of `accurate` depend on whether substeps are fixed; others need no copy of the scene.
    const bool copied = scene.quality.model == Model::Accurate && scene.quality.substepsFixed;
    const double own = copied ? defaultSubsteps(withFreeSubsteps(scene, Model::Accurate)) : defaultSubsteps(scene);
    const double most = std::max(timesOwn * own, substepsOfTenSeconds(scene));
    return static_cast<std::uint32_t>(std::clamp<double>(most, 1, maxSubsteps));
}

std::uint32_t maxRaisedSubsteps(const Scene& scene) {
    constexpr double timesAsked = 256;
    const double most = std::min<double>(timesAsked * scene.quality.substeps, maxSubstepsFor(scene));
    return std::max(scene.quality.substeps, static_cast<std::uint32_t>(most));
}

double maxSpeed(const Scene& scene, double radius) {
    return safeMotion * radius * maxRaisedSubsteps(scene) / scene.step;
}

Result<void> checkSpeeds(const Scene& scene, std::size_t first) {
    const double radiiPerSecond = maxSpeed(scene, 1);
    for (std::size_t id = first; id < scene.spheres.size(); ++id) {
        const Sphere& sphere = scene.spheres[id];
        const double speed = glm::length(glm::dvec3(sphere.velocity));
        const double most = radiiPerSecond * static_cast<double>(sphere.radius);
        if (speed <= most) continue;
        return fail(ErrorKind::Input, at("groups", sphere.group),
                    fmt::format("has a sphere of radius {:g} m with {:g} m/s, the fastest that this scene can compute "
                                "is {:g} m/s; make it slower or larger, or shorten the step",
                                static_cast<double>(sphere.radius), speed, most));
    }
    return {};
}

Result<void> checkObstacleSpeeds(const Scene& scene) {
    const double most = maxSpeed(scene, smallestRadiusIn(scene));
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
        const double speed = scene.obstacles[k].largestSpeed(scene.bounds);
        if (speed <= most || !(most > 0)) continue;
        return fail(
            ErrorKind::Input, at(at("obstacles", k), "motion"),
            fmt::format(
                "moves its surface at up to {:.6g} m/s; with a smallest radius of {:g} m, the scene can compute "
                "{:.6g} m/s: make it slower, or shorten the step",
                speed, smallestRadiusIn(scene), most),
            Cause::Range, {.least = 0, .most = most});
    }
    return {};
}

std::uint32_t minSubstepsFor(const Scene& scene, Model model) {
    double fewest = 0;
    if (model != Model::Accurate) {
        fewest = 1;
    } else if (followsHertz(scene)) {
        fewest = fewestPerContact * scene.step / contactTimeOf(scene).contact;
    } else {
        Scene soft = withFreeSubsteps(scene, model);
        soft.quality.overlap = softest;
        fewest = scene.step / contactTimeOf(soft).substep;
    }
    fewest = std::max(std::ceil(fewest), substepsForFields(scene));
    return static_cast<std::uint32_t>(std::clamp<double>(fewest, 1, maxSubsteps));
}

Result<std::uint32_t> substepsFor(const Scene& scene, Model model) {
    Scene free = withFreeSubsteps(scene, model);
    if (auto fits = checkModel(free); !fits) return tl::unexpected(fits.error());
    if (auto fits = fitSubsteps(free); !fits) return tl::unexpected(fits.error());
    return free.quality.substeps;
}

SubstepRange substepRange(const Scene& scene, Model model) {
    constexpr double fewer = 2;  // factor; with fewer substeps, piles are squeezed
    constexpr double more = 8;
    const double own = defaultSubsteps(withFreeSubsteps(scene, model));
    const double least = minSubstepsFor(scene, model);
    const double fewest = std::clamp<double>(std::floor(own / fewer), least, maxSubsteps);
    return {.fewest = static_cast<std::uint32_t>(fewest),
            .most = static_cast<std::uint32_t>(std::clamp<double>(own * more, fewest, maxSubsteps))};
}

void readQuality(Check& check, const v1::Quality& message, const Overrides& overrides, Scene& scene) {
    Quality& quality = scene.quality;
    if (message.model() < v1::MODEL_UNSPECIFIED || message.model() > v1::ACCURATE) {
        check.refuse("quality.model",
                     fmt::format("is {}, must be FAST, BALANCED or ACCURATE", static_cast<int>(message.model())));
    } else if (message.model() != v1::MODEL_UNSPECIFIED) {
        quality.model = modelOf(message.model());
    }
    quality.model = overrides.model.value_or(quality.model);
    if (auto goal = qualityGoalOf(message.auto_(), "quality.auto")) {
        // A model or substeps that the caller requests stay.
        const bool asked = overrides.model || overrides.substeps;
        quality.goal = overrides.goal || asked ? overrides.goal : *goal;
    } else {
        check.refuse(goal.error().where, goal.error().message);
    }
    if (message.has_overlap()) quality.overlap = check.within(message.overlap(), 1e-6, 0.5, "quality.overlap");
    if (const auto fits = checkModel(scene); !fits) check.refuse(fits.error().where, fits.error().message);
    if (!check.ok()) return;
    quality.substepsFixed = overrides.substeps || message.has_substeps();
    quality.substeps = overrides.substeps.value_or(message.substeps());
    if (const auto fits = fitSubsteps(scene); !fits) check.refuse(fits.error().where, fits.error().message);
    if (!check.ok()) return;
    if (const auto fits = checkSpeeds(scene); !fits) check.refuse(fits.error().where, fits.error().message);
    if (const auto fits = checkObstacleSpeeds(scene); !fits) check.refuse(fits.error().where, fits.error().message);
}

}  // namespace spherule::scene
