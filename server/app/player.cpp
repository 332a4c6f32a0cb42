#include "app/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "app/pacer.h"

namespace spherule::app {

namespace {

constexpr std::uint32_t mostSteps = 100'000;
// s; a frame may come so much before its time, which waits and sums only meet to within rounding.
constexpr double early = 1e-6;

double secondsOf(Player::Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

Player::Player(store::Recording recording, std::string name, bool again, Clock::time_point now)
    : recording_(std::move(recording)), name_(std::move(name)), again_(again), since_(now) {
    wanted_ = recording_.begin();
}

Result<v1::Applied> Player::apply(const v1::Command& command, Clock::time_point now) {
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
            wanted_ = recording_.begin();
            break;
        case v1::Command::kSeek:
            if (!std::isfinite(command.seek().time()))
                return fail(ErrorKind::Refused, "seek.time", "is no finite number");
            wanted_ = std::clamp(command.seek().time(), recording_.begin(), recording_.end());
            break;
        case v1::Command::kSet:
            done = setSpeed(command.set(), now);
            break;
        default:
            return fail(ErrorKind::Refused, "", "a recording is played here: nothing in it can be changed");
    }
    if (!done) return tl::unexpected(done.error());
    v1::Applied applied;
    applied.set_step(recording_.step());
    return applied;
}

Result<void> Player::setSpeed(const v1::Set& set, Clock::time_point now) {
    v1::Set rest = set;
    rest.clear_speed();
    if (rest.ByteSizeLong() > 0)
        return fail(ErrorKind::Refused, "set", "a recording is played here: only its speed can be set");
    if (!set.has_speed()) return {};
    if (auto right = checkSpeed(set.speed()); !right) return right;
    goOnFrom(placeBy(now), now);
    speed_ = set.speed();
    return {};
}

Result<void> Player::step(std::uint32_t count, Clock::time_point now) {
    if (count < 1 || count > mostSteps)
        return fail(ErrorKind::Refused, "step.count", fmt::format("is {}, must be within 1 and {}", count, mostSteps));
    goOnFrom(next_.value_or(placeBy(now)), now);
    paused_ = true;
    steps_ = next_ ? count : 0;
    return {};
}

void Player::resume(Clock::time_point now) {
    if (!next_) wanted_ = recording_.begin();
    goOnFrom(placeBy(now), now);
    paused_ = false;
    steps_ = 0;
}

void Player::goOnFrom(double place, Clock::time_point now) {
    place_ = place;
    since_ = now;
}

double Player::placeBy(Clock::time_point now) const {
    if (paused_ && steps_ == 0) return place_;
    return place_ + speed_ * secondsOf(now - since_);
}

Player::Moved Player::advance(Clock::time_point now) {
    Moved moved;
    if (wanted_) {
        const double place = *std::exchange(wanted_, std::nullopt);
        goOnFrom(place, now);
        goTo(place, moved);
        return moved;
    }
    const double place = placeBy(now) + speed_ * early;
    const bool due = next_ && place >= *next_;
    if (due && steps_ > 0) {
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
    if (auto done = recording_.seek(time); done)
        moved.shown = true;
    else
        skip(done.error(), time, moved);
    auto passed = recording_.takePassed();
    std::ranges::move(passed, std::back_inserter(moved.passed));
    findNext();
}

// Goes on behind what is damaged, or pauses where nothing is.
void Player::skip(const Error& error, double from, Moved& moved) {
    moved.damage.push_back(error.text());
    if (recording_.recover(from)) {
        moved.shown = true;
        place_ += recording_.time() - from;
    } else {
        paused_ = true;
    }
}

void Player::findNext() {
    const auto next = recording_.nextTime();
    // What cannot be read is met, and told, when it is played.
    next_ = next ? *next : recording_.time();
}

std::optional<Player::Clock::time_point> Player::due() const {
    if (wanted_) return since_;
    if (paused_ && steps_ == 0) return std::nullopt;
    const double wait = (next_.value_or(recording_.end()) - place_) / speed_;
    // A recording may say that its next frame comes in a million years.
    constexpr double longest = 3600;
    return since_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(wait, longest)));
}

v1::Timeline Player::timeline() const {
    v1::Timeline timeline;
    timeline.set_file(name_);
    timeline.set_begin(recording_.begin());
    timeline.set_end(recording_.end());
    timeline.set_frames(recording_.frames());
    timeline.set_flaw(recording_.flaw());
    return timeline;
}

v1::Settings Player::settings() const {
    v1::Settings settings = recording_.settings();
    settings.set_speed(speed_);
    settings.set_paused(paused_);
    return settings;
}

}  // namespace spherule::app
