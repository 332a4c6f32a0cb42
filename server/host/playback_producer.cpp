#include "host/playback_producer.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/heartbeat.h"
#include "core/log.h"
#include "core/text.h"
#include "encode/morton.h"
#include "host/to_proto.h"
#include "net/command_rules.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // longest wait of a new viewer for a state while paused
constexpr auto reportEvery = 1s;

}  // namespace

PlaybackProducer::PlaybackProducer(std::unique_ptr<compute::Device> device, Player player, const ProducerIo& io)
    : device_(std::move(device)),
      player_(std::move(player)),
      requests_(io.requests),
      board_(io.board),
      publisher_(io.publisher),
      encoder_(
          *device_, [this](const codec::EncodedFrame& encoded) { publish(encoded); },
          [this](codec::SharedMessage order) { publisher_.setOrder(std::move(order), codec::Audience::Everybody); },
          [this](const std::string& text) { notify(v1::Event::WARNING, text); }, framesMade_) {}

Result<void> PlaybackProducer::run(const std::stop_token& stop) {
    v1::ServerMessage timeline;
    *timeline.mutable_timeline() = player_.timeline();
    publisher_.retain(codec::share(std::move(timeline)));
    while (!stop.stop_requested()) {
        heartbeat::beat("serving viewers");
        // Serves all requests before a frame is decoded: of several seeks only the last matters.
        while (auto request = requests_.tryPop()) serve(*request);
        for (const Request& query : requests_.takeQueries()) serve(query);
        const auto now = encode::StreamEncoder::Clock::now();
        if (auto done = advance(now); !done) return done;
        sendSettings();
        produce(now);
        report(now);
        if (auto request = requests_.popFor(waitTime(encode::StreamEncoder::Clock::now()))) serve(*request);
    }
    return {};
}

encode::StreamEncoder::Clock::duration PlaybackProducer::waitTime(encode::StreamEncoder::Clock::time_point now) const {
    encode::StreamEncoder::Clock::duration wait = longestWait;
    for (const auto due : {player_.due(), encoder_.due()})
        if (due) wait = std::min(wait, std::max(*due - now, encode::StreamEncoder::Clock::duration{}));
    return wait;
}

void PlaybackProducer::serve(const Request& request) {
    const auto applied = player_.apply(request.command, Player::Clock::now());
    if (request.answered) publisher_.reply(request.session, resultOf(request.command, applied));
    if (applied && net::rulesOf(request.command).announced())
        publisher_.announce(request.session, eventOf(request.command, *applied, 0));
}

Result<void> PlaybackProducer::advance(encode::StreamEncoder::Clock::time_point now) {
    const Player::Moved moved = player_.advance(now);
    for (const std::string& damage : moved.damage) notify(v1::Event::WARNING, "Skipped: " + damage);
    for (const v1::ServerMessage& message : moved.skippedEvents) publisher_.broadcast(codec::share(message));
    return moved.shown ? show() : Result<void>();
}

// Uploads the columns of the current frame, and describes the scene if it is another one.
Result<void> PlaybackProducer::show() {
    const recording::Recording& recording = player_.recording();
    const bool anotherScene = epoch_ == 0 || sceneOffset_ != recording.sceneOffset();
    const auto order = recording.order();
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        const auto cells = recording.cells(column);
        const auto quanta = glm::vec3(recording.quanta(column));
        std::vector<glm::vec4>& values = values_[column];
        values.resize(cells.size());
        for (std::size_t k = 0; k < cells.size(); ++k) values[order[k]] = glm::vec4(quanta * glm::vec3(cells[k]), 0);
        if (anotherScene) {
            auto made = device_->createBuffer(codec::columns[column].name, values.size() * sizeof(glm::vec4), "r");
            if (!made) return tl::unexpected(made.error());
            buffers_[column] = std::move(*made);
        }
        device_->upload(*buffers_[column], 0, std::as_bytes(std::span(values)));
    }
    if (anotherScene) describe();
    time_ = recording.time();
    step_ = recording.step();
    poses_.assign(recording.poses().begin(), recording.poses().end());
    ++version_;
    return {};
}

void PlaybackProducer::describe() {
    v1::ServerMessage message;
    v1::SceneFacts& facts = *message.mutable_scene();
    facts = player_.recording().facts();
    sceneOffset_ = player_.recording().sceneOffset();
    facts.set_epoch(++epoch_);
    const auto radii = player_.recording().radii();
    smallest_ = radii.empty() ? 0 : static_cast<double>(*std::ranges::min_element(radii));
    board_.update([&](ServerStatus& current) {
        current.scene = facts.name();
        current.spheres = facts.count();
    });
    publisher_.retain(codec::share(std::move(message)));
}

void PlaybackProducer::sendSettings() {
    v1::ServerMessage message;
    *message.mutable_settings() = player_.settings();
    message.mutable_settings()->clear_rotates();  // frames of a recording have no angular velocities
    std::string bytes = message.SerializeAsString();
    if (bytes == settings_) return;
    settings_ = std::move(bytes);
    nextReport_ = {};
    publisher_.retain(codec::share(std::move(message)));
}

void PlaybackProducer::notify(v1::Event::Kind kind, const std::string& text) {
    spdlog::warn("{}", text);
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_step(player_.recording().step());
    message.mutable_event()->set_text(utf8(text));
    publisher_.broadcast(codec::share(std::move(message)));
}

void PlaybackProducer::produce(encode::StreamEncoder::Clock::time_point now) {
    if (buffers_[0] == nullptr) return;
    encode::FrameSource source;
    for (std::size_t column = 0; column < codec::columnCount; ++column) source.columns[column] = buffers_[column].get();
    encoder_.update({.source = source,
                     .spheres = static_cast<std::uint32_t>(values_[0].size()),
                     .smallestRadius = smallest_,
                     .periods = player_.recording().periods(),
                     .epoch = epoch_,
                     .version = version_,
                     .order =
                         [this] {
                             std::vector<std::uint32_t> ids = encode::mortonOrder(values_[0]);
                             return encode::CodecOrder{.ids = ids, .handles = ids};
                         },
                     .head =
                         [this, now] {
                             v1::Frame head;
                             head.set_step(step_);
                             head.set_sim_time(time_);
                             head.mutable_poses()->Assign(poses_.begin(), poses_.end());
                             *head.mutable_status() = status(now);
                             return head;
                         }},
                    publisher_.subscriptions(), now);
}

void PlaybackProducer::publish(const codec::EncodedFrame& encoded) {
    frameRate_.add(version_, encode::StreamEncoder::Clock::now());
    publisher_.publish(encoded);
}

v1::Status PlaybackProducer::status(encode::StreamEncoder::Clock::time_point now) {
    v1::Status status;
    if (!player_.paused()) status.set_real_time_factor(player_.speed());
    status.set_frames_per_second(frameRate_.perSecond(now));
    status.set_paused(player_.paused());
    status.set_viewers(publisher_.viewers());
    return status;
}

void PlaybackProducer::report(encode::StreamEncoder::Clock::time_point now) {
    if (now < nextReport_) return;
    nextReport_ = now + reportEvery;
    board_.update([&](ServerStatus& current) {
        current.setState(player_.paused() ? "paused" : "running");
        current.steps = step_;
        current.simSeconds = time_;
        current.framesProduced = framesMade_;
        current.status = status(now);
    });
}

}  // namespace spherule::host
