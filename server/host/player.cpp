#include "host/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/text.h"
#include "host/step_scheduler.h"
#include "net/command_rules.h"

namespace spherule::host {

namespace {

// Timer tolerance (s): a frame may be shown this early.
constexpr double early = 1e-6;

double secondsOf(Player::Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

tl::unexpected<Error> refusal() {
    return fail(ErrorKind::Refused, "", "a recording is played here: nothing in it can be changed", Cause::Playback);
}

}  // namespace

Player::Player(recording::Recording recording, std::string name, bool again, Clock::time_point now)
    : recording_(std::move(recording)), name_(std::move(name)), again_(again), since_(now) {
    wanted_ = recording_.begin();
}

Result<sim::Applied> Player::apply(const v1::Command& command, Clock::time_point now) {
    if (!net::rulesOf(command).while_playing()) return refusal();
    Result<void> done;
    switch (command.kind_case()) {
        case v1::Command::kPause:
            goOnFrom(placeBy(now), now);
            paused_ = true;
            steps_ = 0;
            break;
        case v1::Command::kResume:
            resume(now);
            break;
        case v1::Command::kStep:
            done = step(command.step().count(), now);
            break;
        case v1::Command::kReset:
            seek(recording_.begin());
            break;
        case v1::Command::kSeek:
            if (!std::isfinite(command.seek().time()))
                return fail(ErrorKind::Refused, "time", "is no finite number", Cause::Range);
            seek(std::clamp(command.seek().time(), recording_.begin(), recording_.end()));
            break;
        case v1::Command::kSet:
            done = setSpeed(command.set(), now);
            break;
        default:
            return refusal();
    }
    if (!done) return tl::unexpected(done.error());
    return sim::Applied{.step = recording_.step()};
}

Result<void> Player::setSpeed(const v1::Set& set, Clock::time_point now) {
    v1::Set rest = set;
    rest.clear_speed();
    if (rest.ByteSizeLong() > 0)
        return fail(ErrorKind::Refused, "", "a recording is played here: only its speed can be set", Cause::Playback);
    if (!set.has_speed()) return {};
    if (auto right = checkSpeed(set.speed()); !right) return right;
    goOnFrom(placeBy(now), now);
    speed_ = set.speed();
    return {};
}

void Player::seek(double time) {
    wanted_ = time;
    steps_ = 0;
}

Result<void> Player::step(std::uint32_t count, Clock::time_point now) {
    if (auto right = checkStepCount(count); !right) return right;
    if (!wanted_) goOnFrom(next_.value_or(placeBy(now)), now);
    paused_ = true;
    steps_ = wanted_ || next_ ? count : 0;
    return {};
}

void Player::resume(Clock::time_point now) {
    if (!wanted_ && !next_) wanted_ = recording_.begin();
    goOnFrom(placeBy(now), now);
    paused_ = false;
    steps_ = 0;
}

void Player::goOnFrom(double place, Clock::time_point now) {
    place_ = place;
    since_ = now;
}

double Player::placeBy(Clock::time_point now) const {
    return goesOn() ? place_ + speed_ * secondsOf(now - since_) : place_;
}

Player::Moved Player::advance(Clock::time_point now) {
    Moved moved;
    const double place = placeBy(now) + speed_ * early;
    const bool due = goesOn() && next_ && place >= *next_;
    if (wanted_) {
        goOnFrom(*std::exchange(wanted_, std::nullopt), now);
        goTo(place_, moved);
    } else if (due && steps_ > 0) {
        --steps_;
        goTo(*next_, moved);
        if (steps_ == 0) goOnFrom(recording_.time(), now);
    } else if (due) {
        goTo(place, moved);
    } else if (!paused_ && !next_ && place >= recording_.end()) {
        if (again_ && recording_.end() > recording_.begin())
            wanted_ = recording_.begin();
        else
            paused_ = true;
        goOnFrom(recording_.end(), now);
    }
    if (!next_) steps_ = 0;
    return moved;
}

void Player::goTo(double time, Moved& moved) {
    const double before = recording_.time();
    if (auto done = recording_.seek(time); done) {
        moved.shown = true;
        findNext();
    } else {
        // Frames before the damage may have been decoded.
        moved.shown = recording_.time() != before && recording_.shows();
        skip(done.error(), time, moved);
    }
    if (moved.shown) settings_ = recording_.settings();
    auto skippedEvents = recording_.takeSkippedEvents();
    std::ranges::move(skippedEvents, std::back_inserter(moved.skippedEvents));
}

// Continues after the damage, or moves to the end if nothing readable follows.
void Player::skip(const Error& error, double from, Moved& moved) {
    moved.damage.push_back(error.text());
    if (recording_.recover(from)) {
        moved.shown = true;
        place_ += recording_.time() - from;
        findNext();
    } else {
        // The search for a keyframe may have discarded the frame that was decoded before.
        moved.shown = moved.shown && recording_.shows();
        next_.reset();
        place_ = recording_.end();
    }
}

void Player::findNext() {
    const auto next = recording_.nextTime();
    // An unreadable frame is due at once, so that its error is reported when it is played.
    next_ = next ? *next : recording_.time();
}

std::optional<Player::Clock::time_point> Player::due() const {
    if (wanted_) return since_;
    if (!goesOn()) return std::nullopt;
    const double wait = (next_.value_or(recording_.end()) - place_) / speed_;
    // The next frame of a recording may be a million years away. The clock holds 300 years.
    constexpr double longest = 1e9;
    return since_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(wait, longest)));
}

v1::Timeline Player::timeline() const {
    v1::Timeline timeline;
    timeline.set_file(utf8(name_));
    timeline.set_begin(recording_.begin());
    timeline.set_end(recording_.end());
    timeline.set_frames(recording_.frames());
    timeline.set_flaw(recording_.damage());
    return timeline;
}

v1::Settings Player::settings() const {
    v1::Settings settings = settings_;
    settings.set_speed(speed_);
    settings.set_paused(paused_);
    return settings;
}

}  // namespace spherule::host
