#include "diagnostics/dial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/load.h"
#include "scene/quality.h"

namespace spherule::diagnostics {

namespace {

// Returns the time of a substep (s) of `spheres` spheres. It lies on a line through the smallest and the largest timed
// case, which has a constant cost per substep and a cost per sphere.
double substepSeconds(const Rung& rung, double spheres) {
    const auto size = [](const auto& curve) { return curve.second.spheres; };
    const auto seconds = [](const Measured& measured) { return measured.cost * measured.substep; };
    const Measured& small = std::ranges::min_element(rung.curves, {}, size)->second;
    const Measured& large = std::ranges::max_element(rung.curves, {}, size)->second;
    if (small.spheres == large.spheres) return seconds(large) * spheres / large.spheres;
    const double each = std::max(0.0, seconds(large) - seconds(small)) / (large.spheres - small.spheres);
    return std::min(seconds(small), seconds(large)) + each * std::max(0.0, spheres - small.spheres);
}

void addPosition(v1::Dial& dial, const Rung& rung, std::uint32_t substeps, double spheres) {
    v1::DialPosition& position = *dial.add_positions();
    position.set_model(scene::messageOf(rung.model));
    position.set_substeps(substeps);
    position.set_own(rung.factor == 1);
    for (const auto& [name, measured] : rung.curves) {
        v1::CurveError& error = *position.add_errors();
        error.set_curve(name);
        error.set_error(measured.error);
    }
    position.set_step_ms(1000 * substeps * substepSeconds(rung, spheres));
}

}  // namespace

v1::Dial dialFor(const Table& table, const scene::Scene& scene) {
    v1::Dial dial;
    dial.set_measured_on(table.device + ", " + table.renderer);
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
        const auto own = scene::substepsFor(scene, model);
        if (!own) {
            v1::MissingModel& missing = *dial.add_missing();
            missing.set_model(scene::messageOf(model));
            missing.set_reason(own.error().text());
            continue;
        }
        const std::uint32_t fewest = scene::minSubstepsFor(scene, model);
        std::uint32_t last = 0;
        for (const Rung& rung : table.rungs) {
            if (rung.model != model) continue;
            const double substeps = std::round(rung.factor * *own);
            // With few substeps, two rungs may have the same number. The rung with the model's own number is kept, or
            // else the first one.
            if (substeps == last && rung.factor == 1)
                dial.mutable_positions()->RemoveLast();
            else if (substeps < fewest || substeps > scene::maxSubsteps || substeps == last)
                continue;
            last = static_cast<std::uint32_t>(substeps);
            addPosition(dial, rung, last, static_cast<double>(scene.spheres.size()));
        }
    }
    return dial;
}

double estimateMs(const v1::Dial& dial, scene::Model model, std::uint32_t substeps) {
    double nearest = std::numeric_limits<double>::infinity();
    double estimate = 0;
    for (const v1::DialPosition& position : dial.positions()) {
        if (scene::modelOf(position.model()) != model) continue;
        const double ratio = static_cast<double>(substeps) / position.substeps();
        if (const double far = std::abs(std::log(ratio)); far < nearest) {
            nearest = far;
            estimate = position.step_ms() * ratio;
        }
    }
    return estimate;
}

v1::Dial calibrated(v1::Dial dial, double ratio) {
    dial.set_calibrated(true);
    for (v1::DialPosition& position : *dial.mutable_positions()) position.set_step_ms(position.step_ms() * ratio);
    return dial;
}

}  // namespace spherule::diagnostics
