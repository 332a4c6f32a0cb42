#include "checkpoint/log_writer.h"

#include <utility>

#include "core/heartbeat.h"

namespace spherule::checkpoint {

namespace {

using namespace std::chrono_literals;
constexpr auto flushEvery = 1s;
constexpr std::size_t mostQueued = 64U << 20U;  // bytes of entries that wait for the disk

}  // namespace

LogWriter::LogWriter(std::unique_ptr<recording::ByteSink> sink, std::string name, Position position)
    : name_(std::move(name)), sink_(std::move(sink)), position_(position) {}

Result<std::unique_ptr<LogWriter>> LogWriter::begin(std::unique_ptr<recording::ByteSink> sink, std::string name) {
    const std::string head = headOf(FileKind::CommandLog);
    if (auto done = sink->write(head); !done) return tl::unexpected(done.error());
    return std::make_unique<LogWriter>(std::move(sink), std::move(name), positionAfter(head));
}

LogWriter::~LogWriter() {
    const heartbeat::Pause writing;  // the disk may take long
    close();
    thread_.wait();
}

// Ends the log after an error. Called by the thread.
void LogWriter::drop(const Error& error) {
    const bool reported = sink_->ended();
    sink_.reset();
    const std::lock_guard lock(mutex_);
    if (!reported) failure_ = error;
}

// Lets the thread write, unless the log has ended.
void LogWriter::post(std::function<Result<void>()> write) {
    unflushed_ = true;
    thread_.post([this, write = std::move(write)] {
        if (!sink_) return;
        if (const auto done = guarded(write); !done) drop(done.error());
    });
}

void LogWriter::flush(Clock::time_point now) {
    if (!unflushed_ || now - flushed_ < flushEvery) return;
    flushed_ = now;
    post([this] { return sink_->flush(); });
    unflushed_ = false;
}

void LogWriter::sync(std::function<void(std::optional<Position>)> then) {
    thread_.post([this, then = std::move(then)] {
        if (sink_)
            if (const auto done = guarded([this] { return sink_->sync(); }); !done) drop(done.error());
        then(sink_ ? std::optional(position_) : std::nullopt);
    });
}

void LogWriter::addWorld(SavedWorld world) {
    if (!goesOn_) return;
    // Tasks are copied, worlds are not.
    auto shared = std::make_shared<SavedWorld>(std::move(world));
    post([this, shared] {
        return write(std::move(*shared), position_, [this](const std::string& bytes) { return sink_->write(bytes); });
    });
}

void LogWriter::add(const v1::LogEntry& entry) {
    if (!goesOn_) return;
    std::string bytes = entry.SerializeAsString();
    if (bytes.size() > mostPayload)
        return endWith({ErrorKind::Refused, name_, "cannot hold a command of more than 64 MiB"});
    if (queued_ + bytes.size() > mostQueued)
        return endWith({ErrorKind::Refused, name_, "the disk does not take the entries fast enough"});
    queued_ += bytes.size();
    post([this, bytes = std::move(bytes)] {
        queued_ -= bytes.size();
        return sink_->write(recordBytes(Kind::Entry, bytes, position_));
    });
}

void LogWriter::endWith(const Error& error) {
    if (!std::exchange(goesOn_, false)) return;
    thread_.post([this, error] {
        if (!sink_) return;
        static_cast<void>(sink_->flush());
        drop(error);
    });
}

void LogWriter::close() {
    if (!std::exchange(goesOn_, false)) return;
    thread_.post([this] {
        if (!sink_) return;
        const auto done = sink_->close();
        if (!done) return drop(done.error());
        sink_.reset();
    });
}

std::optional<Error> LogWriter::takeFailure() {
    const std::lock_guard lock(mutex_);
    if (failure_) goesOn_ = false;
    return std::exchange(failure_, std::nullopt);
}

}  // namespace spherule::checkpoint
