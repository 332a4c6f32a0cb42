#include "recording/background_writer.h"

#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <utility>

namespace spherule::recording {

namespace {

// Limits of the queue (bytes): for frames, for all records, and for a log.
constexpr std::size_t mostWaiting = 64U << 20U;
constexpr std::size_t mostNeeded = 256U << 20U;
constexpr std::size_t mostLog = mostWaiting / 4;  // beyond them a log waits, so that frames have room

using namespace std::chrono_literals;
constexpr auto checkEvery = 1s;  // checks that the file still exists, while no record comes

constexpr bool frameNeeds(Kind kind) {
    return kind == Kind::Scene || kind == Kind::Order || kind == Kind::Settings;
}

}  // namespace

Result<std::unique_ptr<BackgroundWriter>> BackgroundWriter::create(const std::string& path, bool replace,
                                                                   std::uint64_t mostBytes) {
    auto queue = memory::Claim::make(path, "frames that wait for the disk", mostWaiting);
    if (!queue) return tl::unexpected(queue.error());
    auto writer = Writer::create(path, replace, randomFileId());
    if (!writer) return tl::unexpected(writer.error());
    return std::unique_ptr<BackgroundWriter>(new BackgroundWriter(std::move(*writer), mostBytes, std::move(*queue)));
}

BackgroundWriter::BackgroundWriter(Writer writer, std::uint64_t mostBytes, memory::Claim queue)
    : queue_(std::move(queue)), writer_(std::move(writer)), mostBytes_(mostBytes), thread_([this] { write(); }) {}

BackgroundWriter::~BackgroundWriter() {
    endLog();
    finish();
}

bool BackgroundWriter::add(Kind kind, double time, codec::SharedMessage message) {
    const std::lock_guard lock(mutex_);
    if (progress_.ended || finishing_) return true;
    const std::size_t bytes = waitingBytes_ + message->binary().size();
    if (!frameNeeds(kind) && bytes > mostWaiting) return false;
    if (bytes > mostNeeded) {
        progress_.failure = "the disk is too slow: 256 MiB wait to be written";
        finishing_ = true;
        logging_ = false;
    } else {
        waitingBytes_ = bytes;
        waiting_.push_back({kind, time, std::move(message), {}});
    }
    changed_.notify_all();
    return true;
}

bool BackgroundWriter::addLog(std::string_view bytes) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return progress_.ended || !logging_ || waitingBytes_ <= mostLog; });
    if (progress_.ended || !logging_) return false;
    waitingBytes_ += bytes.size();
    waiting_.push_back({.kind = Kind::Log, .time = 0, .message = nullptr, .log = std::string(bytes)});
    changed_.notify_all();
    return true;
}

void BackgroundWriter::beginLog() {
    const std::lock_guard lock(mutex_);
    logging_ = !progress_.ended && !finishing_;
}

void BackgroundWriter::endLog() {
    const std::lock_guard lock(mutex_);
    logging_ = false;
    changed_.notify_all();
}

void BackgroundWriter::finish() {
    const std::lock_guard lock(mutex_);
    finishing_ = true;
    changed_.notify_all();
}

void BackgroundWriter::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return progress_.ended; });
}

BackgroundWriter::Progress BackgroundWriter::progress() {
    const std::lock_guard lock(mutex_);
    return progress_;
}

void BackgroundWriter::write() {
    Result<void> done;
    try {
        std::vector<Item> items;
        while (done) {
            const auto more = waitForItems(items);
            if (more && !*more) break;
            done = more ? writeItems(items) : tl::unexpected(more.error());
        }
    } catch (const std::exception& error) {
        done = fail(ErrorKind::Refused, "", error.what());
    }
    end(done);
}

// Returns false when no record follows.
Result<bool> BackgroundWriter::waitForItems(std::vector<Item>& items) {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, checkEvery, [this] { return !waiting_.empty() || (finishing_ && !logging_); })) {
        lock.unlock();
        if (auto there = writer_.stillThere(); !there) return tl::unexpected(there.error());
        lock.lock();
    }
    items.assign(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    waitingBytes_ = 0;
    changed_.notify_all();  // addLog() may wait
    return !items.empty();
}

Result<void> BackgroundWriter::writeItems(const std::vector<Item>& items) {
    for (const Item& item : items) {
        const std::string& bytes = item.bytes();
        if (mostBytes_ > 0 && writer_.bytesWith(bytes.size()) > mostBytes_) {
            const std::lock_guard lock(mutex_);
            finishing_ = true;
            logging_ = false;
            waiting_.clear();
            progress_.failure =
                fmt::format("it has reached its limit of {:.1f} MB", static_cast<double>(mostBytes_) / 1e6);
            break;
        }
        const auto done = item.message ? writer_.add(item.kind, item.time, bytes) : writer_.addLog(bytes);
        if (!done) return done;
    }
    const std::lock_guard lock(mutex_);
    progress_.bytes = writer_.bytes();
    progress_.frames = writer_.frames();
    return {};
}

// After an error the file stays as it is: a recording that is cut off.
void BackgroundWriter::end(const Result<void>& done) {
    const Result<void> finished = done ? writer_.finish() : done;
    const std::lock_guard lock(mutex_);
    progress_.ended = true;
    progress_.bytes = writer_.bytes();
    progress_.frames = writer_.frames();
    if (!finished) progress_.failure = finished.error().message;
    waiting_.clear();
    changed_.notify_all();
}

}  // namespace spherule::recording
