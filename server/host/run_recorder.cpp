#include "host/run_recorder.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "codec/order.h"
#include "core/heartbeat.h"
#include "encode/morton.h"
#include "host/facts_message.h"
#include "host/to_proto.h"
#include "scene/describe.h"
#include "sim/pass.h"
#include "sim/state.h"

namespace spherule::host {

namespace {

constexpr double keyframesEvery = 2;  // s simulated
constexpr double roundedBy = 1e-6;    // tolerance (frames): times are sums of steps
constexpr std::uint32_t order = 1;

// The welcome of a recording.
v1::ServerMessage sourceOf(const compute::Device& device) {
    v1::ServerMessage message;
    *message.mutable_welcome() = welcomeOf(device.info());
    // These name the machine and the number of threads. A recording does not depend on them.
    message.mutable_welcome()->clear_renderer();
    message.mutable_welcome()->clear_reason();
    return message;
}

// Returns the id of the file. It follows from all that the run follows from: the same run gives the same file.
std::uint32_t idOf(const v1::ServerMessage& source, const recording::Options& options,
                   const sim::Simulation& simulation, std::string_view plan) {
    const scene::Scene& scene = simulation.scene();
    v1::Scene description = scene::describe(scene, simulation.time(), simulation.flows().emission.progress(scene));
    description.clear_contact_sums();  // they change nothing in a recording
    // Paths depend on the machine. The facts have the triangles, except very many.
    for (v1::Obstacle& obstacle : *description.mutable_obstacles()) {
        if (obstacle.has_mesh()) obstacle.mutable_mesh()->clear_file();
        if (obstacle.has_height_field()) obstacle.mutable_height_field()->clear_file();
    }
    return recording::fileIdOf(source.SerializeAsString() + factsMessage(simulation, 1).SerializeAsString() +
                               description.SerializeAsString() +
                               fmt::format("{} {} {} {}", sim::hashOf(sim::stateOf(scene)),
                                           static_cast<int>(options.tier), options.rate, plan));
}

// Writes a log into a recording, between the records of another thread.
class LogSink : public recording::ByteSink {
  public:
    LogSink(recording::Writer& writer, std::mutex& mutex) : writer_(writer), mutex_(mutex) {}

    Result<void> write(std::string_view bytes) override {
        const std::lock_guard lock(mutex_);
        return writer_.addLog(bytes);
    }

  private:
    recording::Writer& writer_;
    std::mutex& mutex_;
};

}  // namespace

std::unique_ptr<recording::ByteSink> RunRecorder::logSink() {
    return std::make_unique<LogSink>(writer_, mutex_);
}

Result<std::unique_ptr<RunRecorder>> RunRecorder::create(const recording::Options& options, compute::Device& device,
                                                         sim::Simulation& simulation, std::string_view plan) {
    if (simulation.count() == 0 && simulation.scene().emitters.empty())
        return fail(ErrorKind::Input, "--record", "has nothing to record: the scene has no spheres");
    Encoding encoding;
    if (simulation.count() > 0) {
        auto made = makeEncoding(options, device, simulation);
        if (!made) return tl::unexpected(made.error());
        encoding = std::move(*made);
    }
    // The file is created last, so that an existing file is kept if the device has no room.
    const v1::ServerMessage source = sourceOf(device);
    auto writer = recording::Writer::create(options.path, options.replace, idOf(source, options, simulation, plan));
    if (!writer) return tl::unexpected(writer.error());
    std::unique_ptr<RunRecorder> recorder(new RunRecorder(options, device, simulation, std::move(*writer)));
    recorder->encoding_ = std::move(encoding);
    auto done = recorder->add(recording::Kind::Other, source);
    if (done && simulation.count() > 0) done = recorder->beginEpoch();
    if (!done) return tl::unexpected(done.error());
    return recorder;
}

Result<RunRecorder::Encoding> RunRecorder::makeEncoding(const recording::Options& options, compute::Device& device,
                                                        sim::Simulation& simulation) {
    auto context =
        encode::EncoderContext::create(device, simulation.count(), encode::sourceOf(simulation).slotOf != nullptr);
    if (!context) return tl::unexpected(context.error());
    const double smallestRadius = sim::radiusStatsOf(simulation.scene()).smallest;
    auto encoder = encode::FrameEncoder::create(**context, options.tier, smallestRadius,
                                                simulation.scene().bounds.periods(), true);
    if (!encoder) return tl::unexpected(encoder.error());
    return Encoding{.context = std::move(*context), .encoder = std::move(*encoder)};
}

// Writes the scene facts, the order and a keyframe of the present spheres.
Result<void> RunRecorder::beginEpoch() {
    ++epoch_;
    generation_ = simulation_.generation();
    population_ = simulation_.population().version();
    groups_ = simulation_.groupsVersion();
    if (auto done = add(recording::Kind::Scene, factsMessage(simulation_, epoch_)); !done) return done;
    const std::vector<std::uint32_t> ids = encode::mortonOrder(simulation_.snapshot().position);
    std::vector<std::uint32_t> handles;
    for (const std::uint32_t rank : ids) handles.push_back(simulation_.population().handleAt(rank));
    encoding_.context->setOrder(handles);
    v1::ServerMessage message;
    *message.mutable_order() = codec::orderMessage(epoch_, order, ids);
    if (auto done = add(recording::Kind::Order, message); !done) return done;
    if (auto done = writeSettings(); !done) return done;
    keyframe_ = simulation_.time();
    due_ = std::floor(keyframe_ * options_.rate + roundedBy) + 1;
    return write(recording::Kind::Keyframe);
}

Result<void> RunRecorder::stepped(bool last) {
    const double frames = simulation_.time() * options_.rate + roundedBy;
    const bool due = frames >= due_ || last;
    const bool otherSpheres = simulation_.population().version() != population_;
    if (otherSpheres && simulation_.count() == 0) return {};
    if (!encoding_.encoder && simulation_.count() == 0) return {};  // emitters have made none yet
    const bool otherFacts = otherSpheres || simulation_.groupsVersion() != groups_;
    // Emitters and sinks may change the spheres in each step: only the frames need their number.
    if (!encoding_.encoder || simulation_.generation() != generation_ || (otherFacts && due)) {
        encoding_.encoder.reset();
        encoding_.context.reset();
        auto encoding = makeEncoding(options_, device_, simulation_);
        if (!encoding) return tl::unexpected(encoding.error());
        encoding_ = std::move(*encoding);
        return beginEpoch();
    }
    if (auto done = writeSettings(); !done) return done;
    if (!due) return {};
    due_ = std::floor(frames) + 1;
    if (auto done = write(recording::Kind::Delta); !done) return done;
    if (simulation_.time() - keyframe_ + roundedBy / options_.rate < keyframesEvery) return {};
    keyframe_ = simulation_.time();
    return write(recording::Kind::Resync);
}

Result<void> RunRecorder::addEvent(v1::Event::Kind kind, const std::string& text) {
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_text(text);
    message.mutable_event()->set_step(simulation_.steps());
    return add(recording::Kind::Other, message);
}

// Writes the settings if they have changed.
Result<void> RunRecorder::writeSettings() {
    const v1::ServerMessage message = settingsMessage(simulation_.scene(), 1, false);
    std::string bytes = message.SerializeAsString();
    if (bytes == settings_) return {};
    settings_ = std::move(bytes);
    return add(recording::Kind::Settings, message);
}

Result<void> RunRecorder::write(recording::Kind kind) {
    device_.beginTimer(static_cast<unsigned>(sim::Pass::Pack));
    if (kind == recording::Kind::Keyframe)
        encoding_.encoder->encodeKeyframe(encode::sourceOf(simulation_), true);
    else if (kind == recording::Kind::Delta)
        encoding_.encoder->encodeDelta(encode::sourceOf(simulation_), true);
    else
        encoding_.encoder->encodeResync(true);
    device_.endTimer();
    v1::ServerMessage message;
    v1::Frame& frame = *message.mutable_frame();
    encoding_.encoder->download(frame);
    if (auto alive = device_.status(); !alive) return alive;  // the bytes are invalid after a device loss
    frame.set_sequence(kind == recording::Kind::Resync ? sequence_ : ++sequence_);
    frame.set_epoch(epoch_);
    frame.set_step(simulation_.steps());
    frame.set_sim_time(simulation_.time());
    setPoses(frame, simulation_.scene().obstacles, simulation_.time());
    frame.set_count(simulation_.count());
    frame.set_tier(options_.tier);
    frame.set_order(order);
    return add(kind, message);
}

Result<void> RunRecorder::add(recording::Kind kind, const v1::ServerMessage& message) {
    const heartbeat::Pause writing;
    const std::lock_guard lock(mutex_);
    return writer_.add(kind, simulation_.time(), message.SerializeAsString());
}

}  // namespace spherule::host
