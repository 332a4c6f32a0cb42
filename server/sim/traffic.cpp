#include "sim/traffic.h"

#include <algorithm>

namespace spherule::sim {
namespace {

// How many elements of an array a kernel reads or writes, per sphere.
enum class Of : unsigned char { None, Spheres, Visits, Contacts, ListedPairs, TouchingPairs, Pushes, Approaches };

struct Use {
    std::string_view kernel;
    Array array{};
    Of read{};
    Of written{};
    double part = 1;  // of each element that is read
};

// The accesses of the kernels to spheres that rest on each other, away from walls.
constexpr Use uses[] = {
    {"begin_substep.comp", Array::Velocity, Of::Spheres, Of::Spheres},
    {"begin_substep.comp", Array::AngularVelocity, Of::Spheres, Of::Spheres},
    {"begin_substep.comp", Array::VelocityBefore, Of::None, Of::Spheres},
    {"begin_substep.comp", Array::UnheldVelocity, Of::Spheres, Of::Spheres},
    {"begin_substep.comp", Array::UnheldSpin, Of::Spheres, Of::Spheres},
    {"begin_substep.comp", Array::AccelerationXz, Of::Spheres, Of::Spheres},
    {"begin_substep.comp", Array::AccelerationYz, Of::Spheres, Of::Spheres},
    {"solve_contacts.comp", Array::Position, Of::Visits, Of::Pushes},
    {"solve_contacts.comp", Array::Velocity, Of::Contacts, Of::Contacts},
    {"solve_contacts.comp", Array::AngularVelocity, Of::Contacts, Of::Contacts},
    {"solve_contacts.comp", Array::VelocityBefore, Of::Approaches, Of::None},
    {"solve_contacts.comp", Array::Pairs, Of::ListedPairs, Of::None},
    {"solve_contacts.comp", Array::ContactX, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_contacts.comp", Array::ContactY, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_contacts.comp", Array::ContactZ, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_contacts.comp", Array::TorqueX, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_contacts.comp", Array::TorqueY, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_contacts.comp", Array::TorqueZ, Of::TouchingPairs, Of::TouchingPairs},
    {"finish_substep.comp", Array::Position, Of::Spheres, Of::Spheres},
    {"finish_substep.comp", Array::Velocity, Of::Spheres, Of::None},
    {"finish_substep.comp", Array::UnheldVelocity, Of::Spheres, Of::None, 0.25},
    {"finish_substep.comp", Array::ListReference, Of::Spheres, Of::None},
    {"integrate.comp", Array::Position, Of::Spheres, Of::Spheres},
    {"integrate.comp", Array::PositionLow, Of::Spheres, Of::Spheres},
    {"integrate.comp", Array::Velocity, Of::Spheres, Of::Spheres},
    {"integrate.comp", Array::ListReference, Of::Spheres, Of::None},
    {"solve_impulses.comp", Array::Position, Of::Visits, Of::Contacts},
    {"solve_impulses.comp", Array::Velocity, Of::Visits, Of::Contacts},
    {"solve_impulses.comp", Array::AngularVelocity, Of::Contacts, Of::Contacts},
    {"solve_impulses.comp", Array::Pairs, Of::ListedPairs, Of::None},
    {"walls_impulses.comp", Array::Position, Of::Spheres, Of::None},
    {"solve_forces.comp", Array::Position, Of::Visits, Of::None},
    {"solve_forces.comp", Array::PositionLow, Of::Visits, Of::None},
    {"solve_forces.comp", Array::Velocity, Of::Contacts, Of::None},
    {"solve_forces.comp", Array::AngularVelocity, Of::Contacts, Of::None},
    {"solve_forces.comp", Array::DeltaVelocity, Of::Contacts, Of::Contacts},
    {"solve_forces.comp", Array::DeltaOmega, Of::Contacts, Of::Contacts},
    {"solve_forces.comp", Array::Pairs, Of::ListedPairs, Of::None},
    {"solve_forces.comp", Array::ContactX, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_forces.comp", Array::ContactY, Of::TouchingPairs, Of::TouchingPairs},
    {"solve_forces.comp", Array::ContactZ, Of::TouchingPairs, Of::TouchingPairs},
    {"walls_forces.comp", Array::Position, Of::Spheres, Of::None},
    {"walls_forces.comp", Array::AngularVelocity, Of::Spheres, Of::None},
    {"walls_forces.comp", Array::WallSlip, Of::Spheres, Of::None},
    {"apply_forces.comp", Array::Velocity, Of::Spheres, Of::Spheres},
    {"apply_forces.comp", Array::AngularVelocity, Of::Spheres, Of::Spheres},
    {"apply_forces.comp", Array::DeltaVelocity, Of::Spheres, Of::Spheres},
    {"apply_forces.comp", Array::DeltaOmega, Of::Spheres, Of::Spheres},
};

double countOf(Of of, const Plan& plan, const BedMeans& means) {
    switch (of) {
        case Of::Spheres:
            return 1;
        case Of::Visits:
            return means.visits;
        case Of::Contacts:
            return means.contacts;
        case Of::ListedPairs:
            return means.listedPairs;
        case Of::TouchingPairs:
            return means.touchingPairs;
        // Contacts without friction are springs: they push no sphere, and have few impacts.
        case Of::Pushes:
            return plan.features.has(Feature::Friction) ? means.contacts : 0;
        case Of::Approaches:
            return plan.features.has(Feature::Friction) ? means.approaches : 0;
        case Of::None:
            break;
    }
    return 0;
}

}  // namespace

BedMeans bedMeansOf(scene::Model model) {
    switch (model) {
        case scene::Model::Fast:
            return {.listedPairs = 10.1, .touchingPairs = 0, .visits = 1.76, .contacts = 1.41, .approaches = 0};
        case scene::Model::Balanced:
            return {.listedPairs = 6.0, .touchingPairs = 2.6, .visits = 1.75, .contacts = 1.47, .approaches = 0.64};
        case scene::Model::Accurate:
            break;
    }
    return {.listedPairs = 4.0, .touchingPairs = 2.3, .visits = 1.73, .contacts = 1.54, .approaches = 0};
}

std::vector<Traffic> trafficOf(const Plan& plan, const BedMeans& means) {
    std::vector<Traffic> rows;
    if (!plan.features.has(Feature::Contacts) || !plan.features.has(Feature::Gravity)) return rows;  // no bed
    std::vector<std::string_view> done;
    for (const LaunchSpec& launch : plan.substep) {
        if (launch.observing || launch.launchRow || std::ranges::find(done, launch.kernel) != done.end()) continue;
        done.push_back(launch.kernel);
        for (const Use& use : uses) {
            if (use.kernel != launch.kernel || !plan.has(use.array)) continue;
            const auto bytes = static_cast<double>(typeOf(use.array).elementBytes);
            rows.push_back({use.kernel, use.array, bytes * use.part * countOf(use.read, plan, means),
                            bytes * countOf(use.written, plan, means)});
        }
    }
    return rows;
}

}  // namespace spherule::sim
