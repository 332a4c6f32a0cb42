#include "host/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "sim/pass.h"

namespace spherule::host {

struct Metrics::Families {
    prometheus::Registry registry;

    // Raises the counter to `value`, a total that is counted elsewhere.
    void counter(const char* name, const char* help, double value, const prometheus::Labels& labels = {}) {
        auto& metric = prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add(labels);
        metric.Increment(std::max(0.0, value - metric.Value()));
    }
    void gauge(const char* name, const char* help, double value, const prometheus::Labels& labels = {}) {
        prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add(labels).Set(value);
    }
};

namespace {

// The forces on the surfaces of the present scene. They have a registry of their own, because a registry never forgets
// a label.
std::vector<prometheus::MetricFamily> forcesOf(const v1::Statistics& now) {
    prometheus::Registry registry;
    const auto add = [&registry](const char* name, const char* help, const std::string& surface, const auto& values) {
        constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
        auto& family = prometheus::BuildGauge().Name(name).Help(help).Register(registry);
        for (int axis = 0; axis < values.size(); ++axis)
            family.Add({{"surface", surface}, {"axis", axes[axis]}}).Set(values[axis]);
    };
    for (const v1::SurfaceForce& on : now.surface_forces()) {
        add("spherule_surface_force_newtons", "Force of the spheres on a wall or an obstacle, mean of a second",
            on.surface(), on.force());
        add("spherule_surface_torque_newton_metres", "Torque of that force about the centre of the bounds",
            on.surface(), on.torque());
    }
    return registry.Collect();
}

}  // namespace

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
Metrics::~Metrics() = default;

std::string Metrics::text(const ServerStatus& status, const net::Counters& net) {
    Families& to = *families_;
    const auto count = [](const net::Counters::Count& value) { return static_cast<double>(value.load()); };

    to.gauge("spherule_device_info", "The device, as labels", 1,
             {{"device", status.device.kind}, {"renderer", status.device.renderer}});
    to.counter("spherule_spheres_born_total", "Spheres that were there at the beginning, or were added", status.born);
    to.counter("spherule_spheres_removed_total", "Spheres that were removed", status.removed);
    to.gauge("spherule_spheres", "Spheres in the scene", status.spheres);
    to.gauge("spherule_sleeping_spheres", "Spheres asleep, while a viewer watches", status.status.sleeping());
    to.gauge("spherule_outside_spheres", "Spheres outside the bounds, while a viewer watches", status.status.outside());
    to.gauge("spherule_non_finite_spheres", "Spheres without finite state", status.status.non_finite());
    to.gauge("spherule_real_time_factor", "Simulated seconds per wall second", status.status.real_time_factor());
    if (status.state == "running" || status.state == "paused")
        to.gauge("spherule_paused", "1 while the simulation, or the playback, is paused",
                 status.state == "paused" ? 1 : 0);
    to.gauge("spherule_steps", "Steps since the scene began", static_cast<double>(status.steps));
    to.gauge("spherule_simulated_seconds", "Simulated time since the scene began", status.simSeconds);
    to.gauge("spherule_list_rebuilds", "Rebuilds of the pair lists since the scene last changed", status.rebuilds);
    to.counter("spherule_states_produced_total", "State frames produced", static_cast<double>(status.framesProduced));
    for (std::size_t pass = 0; pass < status.passSeconds.size(); ++pass)
        to.counter("spherule_pass_seconds_total", "Device time per pass, while a viewer watches or metrics are read",
                   status.passSeconds[pass], {{"pass", std::string(sim::nameOf(static_cast<sim::Pass>(pass)))}});

    to.gauge("spherule_recording_active", "1 while a recording is made", status.recording.active() ? 1 : 0);
    to.gauge("spherule_recording_bytes", "Size of that recording, or of the last",
             static_cast<double>(status.recording.bytes()));
    to.counter("spherule_recording_frames_lost_total", "Frames left out of recordings: the disk was too slow",
               static_cast<double>(status.recordingFramesLost));

    if (const auto& checkpoints = status.checkpoints) {
        const std::chrono::duration<double> age = std::chrono::steady_clock::now() - checkpoints->safeAt;
        to.gauge("spherule_checkpoint_age_seconds",
                 "Time since the state of the last checkpoint that is on the disk, or since the start", age.count());
        to.counter("spherule_checkpoints_total", "Checkpoints written", static_cast<double>(checkpoints->written));
        to.counter("spherule_checkpoint_failures_total", "Checkpoints that could not be written",
                   static_cast<double>(checkpoints->failed));
        to.gauge("spherule_checkpoint_bytes", "Size of the last checkpoint", static_cast<double>(checkpoints->bytes));
    }

    if (status.diagnostics) addDiagnostics(*status.diagnostics);

    to.gauge("spherule_sessions", "Open sessions", count(net.sessions));
    to.counter("spherule_sessions_accepted_total", "Sessions ever", count(net.accepted));
    to.counter("spherule_http_requests_total", "HTTP requests answered", count(net.httpRequests));
    to.counter("spherule_commands_total", "Commands received", count(net.commands));
    to.counter("spherule_frames_sent_total", "State frames sent, over all sessions", count(net.framesSent));
    to.counter("spherule_chains_lost_total", "Times that a viewer missed a frame and needed a keyframe",
               count(net.chainsLost));
    to.counter("spherule_bytes_sent_total", "Payload bytes sent", count(net.bytesSent));
    for (std::size_t cause = 0; cause < net.closed.size(); ++cause)
        to.counter("spherule_sessions_closed_total", "Sessions ended, by cause", count(net.closed[cause]),
                   {{"cause", std::string(net::closeCauseNames[cause])}});
    for (std::size_t cause = 0; cause < net.rejected.size(); ++cause)
        to.counter("spherule_rejected_total", "Connections, requests, handshakes and commands turned away, by cause",
                   count(net.rejected[cause]), {{"cause", std::string(net::rejectReasonNames[cause])}});
    std::vector<prometheus::MetricFamily> families = to.registry.Collect();
    if (status.diagnostics) std::ranges::move(forcesOf(status.diagnostics->statistics()), std::back_inserter(families));
    return prometheus::TextSerializer().Serialize(families);
}

// Figures of the last second. They exist only while a viewer watches, and for 150 s after a request for metrics.
void Metrics::addDiagnostics(const v1::Diagnostics& diagnostics) {
    Families& to = *families_;
    const v1::Statistics& now = diagnostics.statistics();
    to.gauge("spherule_substeps", "Substeps per step", diagnostics.substeps());
    to.gauge("spherule_step_seconds", "Wall time per step", diagnostics.step_ms() / 1000);
    to.gauge("spherule_energy_rises", "1 if energy increased lately without an energy source",
             diagnostics.energy_rises() ? 1 : 0);
    constexpr const char* energy = "spherule_energy_joules";
    constexpr const char* energyHelp = "Mechanical energy; potential energy is 0 at the floor of the bounds";
    to.gauge(energy, energyHelp, now.kinetic_energy(), {{"kind", "kinetic"}});
    to.gauge(energy, energyHelp, now.rotational_energy(), {{"kind", "rotational"}});
    to.gauge(energy, energyHelp, now.elastic_energy(), {{"kind", "elastic"}});
    to.gauge(energy, energyHelp, now.potential_energy(), {{"kind", "potential"}});
    to.gauge("spherule_push_work_joules",
             "Work against gravity and fields when the model fast moves spheres out of walls", now.push_work());
    const auto vector = [&to](const char* name, const char* help, const auto& values) {
        constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
        for (int axis = 0; axis < values.size(); ++axis) to.gauge(name, help, values[axis], {{"axis", axes[axis]}});
    };
    vector("spherule_momentum_newton_seconds", "Sum of mass times velocity", now.momentum());
    vector("spherule_angular_momentum_newton_metre_seconds",
           "Angular momentum about the centre of the bounds, spins included", now.angular_momentum());
    if (now.has_restitution()) {
        to.gauge("spherule_restitution_achieved_ratio",
                 "Speed of separation over speed of approach, of observed impacts between spheres", now.restitution());
        to.gauge("spherule_restitution_asked_ratio", "Restitution that the materials require for the observed impacts",
                 now.restitution_asked());
    }
    if (now.has_collisions()) {
        to.gauge("spherule_collisions", "Collisions between spheres since the spheres were last placed or added",
                 static_cast<double>(now.collisions()));
        to.gauge("spherule_dissipated_joules", "Energy that contacts have dissipated since then",
                 now.dissipated_energy());
        const auto tensor = [&to](const char* name, const char* help, const auto& values) {
            constexpr std::array<const char*, 6> components = {"xx", "yy", "zz", "xy", "xz", "yz"};
            for (int k = 0; k < values.size(); ++k) to.gauge(name, help, values[k], {{"component", components[k]}});
        };
        tensor("spherule_kinetic_stress_pascals", "Sum of m v v over the volume of the bounds", now.kinetic_stress());
        tensor("spherule_contact_stress_pascals", "Virial stress of the contacts between spheres, mean of a second",
               now.contact_stress());
    }
    to.gauge("spherule_contacts", "Pairs of spheres that overlap", static_cast<double>(now.contacts()));
    to.gauge("spherule_overlap_mean_ratio", "Mean overlap of pairs that overlap, over the smaller radius",
             now.overlap_mean());
    to.gauge("spherule_overlap_max_ratio", "Largest overlap", now.overlap_max());
    to.gauge("spherule_wall_overlap_max_ratio", "Deepest sphere in a wall, over its radius", now.wall_overlap_max());
    to.gauge("spherule_speed_max_metres_per_second", "Speed of the fastest sphere", now.speed_max());
    to.gauge("spherule_speed_rms_metres_per_second", "Root mean square of the speeds", now.speed_rms());
}

}  // namespace spherule::host
