#include "app/play_loop.h"

#include <algorithm>
#include <span>
#include <utility>

#include "app/to_proto.h"
#include "core/heartbeat.h"
#include "core/log.h"
#include "core/text.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // longest wait of a new viewer for a state while paused
constexpr auto reportEvery = 1s;

}  // namespace

PlayLoop::PlayLoop(std::unique_ptr<compute::Device> device, Player player, const Stage& stage)
    : device_(std::move(device)),
      player_(std::move(player)),
      requests_(stage.requests),
      live_(stage.live),
      outlets_(stage.outlets),
      chains_(
          *device_, [this](const codec::EncodedFrame& encoded) { publish(encoded); },
          [this](codec::SharedMessage order) { outlets_.order(std::move(order)); },
          [this](const std::string& text) { say(v1::Event::WARNING, text); }) {}

Result<void> PlayLoop::run(const std::stop_token& stop) {
    v1::ServerMessage timeline;
    *timeline.mutable_timeline() = player_.timeline();
    outlets_.retain(codec::share(std::move(timeline)));
    while (!stop.stop_requested()) {
        heartbeat::beat("serving viewers");
        // Serves all requests before a frame is decoded: of several seeks only the last matters.
        while (auto request = requests_.tryPop()) serve(*request);
        for (const Request& query : requests_.takeQueries()) serve(query);
        const auto now = Chains::Clock::now();
        if (auto done = advance(now); !done) return done;
        sendSettings();
        produce(now);
        report(now);
        if (auto request = requests_.popFor(patience(Chains::Clock::now()))) serve(*request);
    }
    return {};
}

Chains::Clock::duration PlayLoop::patience(Chains::Clock::time_point now) const {
    Chains::Clock::duration wait = longestWait;
    for (const auto due : {player_.due(), chains_.due()})
        if (due) wait = std::min(wait, std::max(*due - now, Chains::Clock::duration{}));
    return wait;
}

void PlayLoop::serve(const Request& request) {
    outlets_.reply(request.session, resultOf(request.command, player_.apply(request.command, Player::Clock::now())));
}

Result<void> PlayLoop::advance(Chains::Clock::time_point now) {
    const Player::Moved moved = player_.advance(now);
    for (const std::string& damage : moved.damage) say(v1::Event::WARNING, "Skipped: " + damage);
    for (const v1::ServerMessage& message : moved.skippedEvents) outlets_.broadcast(codec::share(message));
    return moved.shown ? show() : Result<void>();
}

// Uploads the positions of the current frame, and describes the scene if it is another one.
Result<void> PlayLoop::show() {
    const recording::Recording& recording = player_.recording();
    const auto cells = recording.cells();
    const auto order = recording.order();
    const auto quantum = static_cast<float>(recording.quantum());
    state_.position.resize(cells.size());
    for (std::size_t k = 0; k < cells.size(); ++k)
        state_.position[order[k]] = glm::vec4(quantum * glm::vec3(cells[k]), 0);
    if (epoch_ == 0 || sceneOffset_ != recording.sceneOffset()) {
        const std::size_t bytes = state_.position.size() * sizeof(glm::vec4);
        auto made = device_->createBuffer("positions", bytes, "r");
        if (!made) return tl::unexpected(made.error());
        positions_ = std::move(*made);
        describe();
    }
    device_->upload(*positions_, 0, std::as_bytes(std::span(state_.position)));
    time_ = recording.time();
    step_ = recording.step();
    ++version_;
    return {};
}

void PlayLoop::describe() {
    v1::ServerMessage message;
    v1::SceneFacts& facts = *message.mutable_scene();
    facts = player_.recording().facts();
    sceneOffset_ = player_.recording().sceneOffset();
    facts.set_epoch(++epoch_);
    const auto radii = player_.recording().radii();
    smallest_ = radii.empty() ? 0 : static_cast<double>(*std::ranges::min_element(radii));
    live_.update([&](LiveReport& report) {
        report.scene = facts.name();
        report.spheres = facts.count();
    });
    outlets_.retain(codec::share(std::move(message)));
}

void PlayLoop::sendSettings() {
    v1::ServerMessage message;
    *message.mutable_settings() = player_.settings();
    std::string bytes = message.SerializeAsString();
    if (bytes == settings_) return;
    settings_ = std::move(bytes);
    nextReport_ = {};
    outlets_.retain(codec::share(std::move(message)));
}

void PlayLoop::say(v1::Event::Kind kind, const std::string& text) {
    spdlog::warn("{}", text);
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_step(player_.recording().step());
    message.mutable_event()->set_text(utf8(text));
    outlets_.broadcast(codec::share(std::move(message)));
}

void PlayLoop::produce(Chains::Clock::time_point now) {
    if (!positions_) return;
    chains_.serve({.source = {.position = positions_.get(), .slotOf = nullptr},
                   .spheres = state_.count(),
                   .smallestRadius = smallest_,
                   .epoch = epoch_,
                   .version = version_,
                   .positions = [this] { return state_; },
                   .head =
                       [this, now] {
                           v1::Frame head;
                           head.set_step(step_);
                           head.set_sim_time(time_);
                           *head.mutable_status() = status(now);
                           return head;
                       }},
                  outlets_.subscriptions(), now);
}

void PlayLoop::publish(const codec::EncodedFrame& encoded) {
    states_.shown(version_, Chains::Clock::now());
    outlets_.frame(encoded);
}

v1::Status PlayLoop::status(Chains::Clock::time_point now) {
    v1::Status status;
    if (!player_.paused()) status.set_real_time_factor(player_.speed());
    status.set_frames_per_second(states_.perSecond(now));
    status.set_paused(player_.paused());
    status.set_viewers(outlets_.viewers());
    return status;
}

void PlayLoop::report(Chains::Clock::time_point now) {
    if (now < nextReport_) return;
    nextReport_ = now + reportEvery;
    live_.update([&](LiveReport& report) {
        report.becomes(player_.paused() ? "paused" : "running");
        report.steps = step_;
        report.simSeconds = time_;
        report.framesProduced = chains_.made();
        report.status = status(now);
    });
}

}  // namespace spherule::app
