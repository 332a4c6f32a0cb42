#include "recording/live_recorder.h"

#include "core/log.h"
#include "core/text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

namespace spherule::recording {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto keyframesEvery = 2s;
constexpr auto stateEvery = 1s;
constexpr std::uint64_t leastRoom = 1U << 20U;  // bytes
constexpr std::size_t mostFiles = 1000;
constexpr std::size_t longestName = 40;
constexpr const char* suffix = ".sph";

// A scene's name may have any characters. A file name gets only letters, digits, - and _.
std::string fileNameOf(std::string name) {
    std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; });
    return name.empty() ? "scene" : name.substr(0, longestName);
}

// Writes a log into a recording.
class LogSink : public ByteSink {
  public:
    explicit LogSink(std::shared_ptr<BackgroundWriter> writer) : writer_(std::move(writer)) { writer_->beginLog(); }
    LogSink(const LogSink&) = delete;
    LogSink& operator=(const LogSink&) = delete;
    ~LogSink() override { writer_->endLog(); }

    Result<void> write(std::string_view bytes) override {
        if (writer_->addLog(bytes)) return {};
        ended_ = true;
        return fail(ErrorKind::Refused, "", "the recording has ended");
    }
    [[nodiscard]] bool ended() const override { return ended_; }  // the recording reports why
    Result<void> close() override {
        writer_->endLog();
        return {};
    }

  private:
    std::shared_ptr<BackgroundWriter> writer_;
    bool ended_ = false;
};

}  // namespace

LiveRecorder::LiveRecorder(LiveOptions options, v1::Welcome source)
    : options_(std::move(options)), rendition_{options_.tier, static_cast<std::uint32_t>(options_.rate), true} {
    v1::ServerMessage message;
    *message.mutable_welcome() = std::move(source);
    source_ = codec::share(std::move(message));
}

Result<void> LiveRecorder::startFromOptions() {
    if (options_.path.empty()) return {};
    return start(options_.path, options_.replace, 0);
}

Result<void> LiveRecorder::start() {
    if (writer_ && stopping_)
        return fail(ErrorKind::Refused, "",
                    fmt::format("{} is still being written: wait until it is done", state_.file()), Cause::Busy);
    if (writer_)
        return fail(ErrorKind::Refused, "", fmt::format("{} is being recorded already", state_.file()),
                    Cause::RecordingAlready);
    const auto room = roomInFolder();
    if (!room) return tl::unexpected(room.error());
    const auto path = newPath();
    if (!path) return tl::unexpected(path.error());
    if (auto started = start(*path, false, *room); !started) return started;
    files_.push_back(*path);
    return {};
}

Result<std::uint64_t> LiveRecorder::roomInFolder() const {
    if (options_.folder.empty())
        return fail(ErrorKind::Refused, "", "this server keeps no recordings: start it with --recordings FOLDER",
                    Cause::NoRecordings);
    std::error_code error;
    if (fs::create_directories(options_.folder, error))
        spdlog::warn("the folder of recordings, {}, was not there: it has been made", options_.folder);
    if (error)
        return fail(ErrorKind::Refused, "",
                    fmt::format("the folder {} cannot be made: {}", options_.folder, error.message()));
    std::uint64_t taken = 0;
    std::size_t files = 0;
    for (fs::directory_iterator file(options_.folder, error), end; !error && file != end; file.increment(error)) {
        std::error_code ignored;  // the file may have been deleted
        if (file->path().extension() != suffix) continue;
        const auto bytes = file->file_size(ignored);
        if (!ignored) taken += bytes;
        ++files;
    }
    if (error)
        return fail(ErrorKind::Refused, "",
                    fmt::format("the folder {} cannot be read: {}", options_.folder, error.message()));
    if (files >= mostFiles)
        return fail(ErrorKind::Refused, "", fmt::format("{} has {} recordings: delete some", options_.folder, files),
                    Cause::RecordingsFull);
    if (taken + leastRoom <= options_.folderBytes) return options_.folderBytes - taken;
    return fail(ErrorKind::Refused, "",
                fmt::format("the recordings in {} take up {} MB, all that --recordings-limit allows: delete some",
                            options_.folder, taken / 1'000'000),
                Cause::RecordingsFull);
}

// Returns a path with the scene and the time. It has a number if that file exists already.
Result<std::string> LiveRecorder::newPath() const {
    const std::string scene = scene_ ? scene_->content().scene().name() : "";
    const std::string name = fmt::format("{}-{:%Y%m%d-%H%M%S}", fileNameOf(scene), fmt::gmtime(std::time(nullptr)));
    for (int k = 1; k < 1000; ++k) {
        const fs::path path = fs::path(options_.folder) / ((k == 1 ? name : fmt::format("{}-{}", name, k)) + suffix);
        std::error_code error;
        if (!fs::exists(path, error) && !error) return path.string();
    }
    return fail(ErrorKind::Refused, "", fmt::format("{} has no name left for another recording", options_.folder));
}

Result<void> LiveRecorder::start(const std::string& path, bool replace, std::uint64_t mostBytes) {
    auto writer = BackgroundWriter::create(path, replace, mostBytes);
    if (!writer) return tl::unexpected(writer.error());
    writer_ = std::move(*writer);
    wantsLog_ = options_.log;
    stopping_ = false;
    endedEmpty_ = false;
    state_.Clear();
    state_.set_active(true);
    state_.set_file(utf8(path));
    reported_ = false;
    number_.reset();
    begin_ = time_ = offset_ = simTime_ = 0;
    timed_ = false;
    waits_ = false;
    return {};
}

Result<void> LiveRecorder::stop() {
    if (!writer_) return fail(ErrorKind::Refused, "", "nothing is being recorded", Cause::NotRecording);
    wantsLog_ = false;
    stopping_ = true;
    writer_->finish();
    return {};
}

std::unique_ptr<ByteSink> LiveRecorder::logSink() {
    return std::make_unique<LogSink>(writer_);
}

void LiveRecorder::retain(codec::SharedMessage message) {
    const v1::ServerMessage& content = message->content();
    if (content.has_scene()) {
        order_.reset();
        number_.reset();
        if (writer_ && timed_) add(Kind::Scene, message);
        scene_ = std::move(message);
    } else if (content.has_settings()) {
        if (writer_ && timed_) add(Kind::Settings, message);
        settings_ = std::move(message);
    }
}

void LiveRecorder::broadcast(const codec::SharedMessage& message) {
    if (writer_ && timed_ && message->content().has_event()) add(Kind::Other, message);
}

void LiveRecorder::setOrder(codec::SharedMessage message) {
    if (writer_ && timed_) add(Kind::Order, message);
    order_ = std::move(message);
}

void LiveRecorder::publish(const codec::EncodedFrame& encoded) {
    if (!writer_ || encoded.rendition != rendition_) return;
    using enum codec::EncodedFrame::Kind;
    const bool again = encoded.kind == Resync && number_ == encoded.number;
    if (!again) {
        waits_ = timed_ && standsStill(encoded.message->content().frame());
        if (waits_) return leaveOut(encoded.message->content().frame());
    }
    if (encoded.kind == Delta && number_ != encoded.number - 1) {
        number_.reset();
        if (refused_) ++framesLost_;
        return;
    }
    // Skip resync keyframes meant for other viewers, unless the newest keyframe is older than keyframesEvery.
    if (again && (!moved_ || Clock::now() - keyframe_ < keyframesEvery)) return;
    refused_ = false;
    const bool first = !timed_;
    timeOf(encoded.message->content().frame());
    if (first) {
        // Add the messages so far, in the order in which a reader needs them.
        add(Kind::Other, source_);
        for (const auto& [kind, message] :
             {std::pair(Kind::Scene, scene_), {Kind::Order, order_}, {Kind::Settings, settings_}})
            if (message) add(kind, message);
    }
    moved_ = encoded.kind == Delta;
    if (!moved_) keyframe_ = Clock::now();
    number_ = encoded.number;
    // A lost chain begins again with a keyframe.
    add(again ? Kind::Resync : encoded.kind == Delta ? Kind::Delta : Kind::Keyframe, encoded.message);
}

// Returns true when the world has not advanced since the newest frame. A paused world that was reset has not advanced
// either.
bool LiveRecorder::standsStill(const v1::Frame& frame) const {
    return frame.sim_time() == simTime_ || (frame.status().paused() && frame.sim_time() + offset_ <= time_);
}

// Skips a frame. The chain is lost then, and begins again when the world advances.
void LiveRecorder::leaveOut(const v1::Frame& frame) {
    number_.reset();
    timeOf(frame);
}

void LiveRecorder::timeOf(const v1::Frame& frame) {
    if (!timed_) begin_ = time_ = frame.sim_time();
    timed_ = true;
    simTime_ = frame.sim_time();
    if (frame.sim_time() + offset_ < time_) offset_ = time_ - frame.sim_time();
    // Rounding must not make the time go back.
    time_ = std::max(time_, frame.sim_time() + offset_);
}

void LiveRecorder::add(Kind kind, const codec::SharedMessage& message) {
    if (writer_->add(kind, time_, message)) return;
    if (!message->content().has_frame()) return;
    number_.reset();
    refused_ = true;
    ++framesLost_;
}

void LiveRecorder::subscribe(std::vector<codec::Subscription>& subscriptions, Clock::time_point now) const {
    if (!writer_) return;
    auto own = std::ranges::find(subscriptions, rendition_, &codec::Subscription::rendition);
    if (own == subscriptions.end())
        own = subscriptions.insert(subscriptions.end(), codec::Subscription{.rendition = rendition_});
    own->newcomer = own->newcomer || !timed_;
    own->lost = own->lost || (!waits_ && (!number_ || (moved_ && now - keyframe_ >= keyframesEvery)));
}

std::optional<v1::Recording> LiveRecorder::finish() {
    if (!writer_) return std::nullopt;
    writer_->finish();
    writer_->wait();
    return changedState(Clock::now());
}

std::optional<v1::Recording> LiveRecorder::changedState(Clock::time_point now) {
    if (writer_) {
        const auto progress = writer_->progress();
        state_.set_duration(time_ - begin_);
        state_.set_bytes(progress.bytes);
        if (progress.ended) {
            state_.set_active(false);
            endedEmpty_ = progress.failure.empty() && progress.frames == 0;
            state_.set_failure(endedEmpty_ ? "nothing was recorded: no frame has come" : progress.failure);
            writer_.reset();
            wantsLog_ = false;
            reported_ = false;
        } else if (now - reportedAt_ >= stateEvery) {
            reported_ = false;
        }
    }
    if (std::exchange(reported_, true)) return std::nullopt;
    reportedAt_ = now;
    return state_;
}

}  // namespace spherule::recording
