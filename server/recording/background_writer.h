#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "codec/message.h"
#include "core/memory.h"
#include "core/result.h"
#include "recording/writer.h"

namespace spherule::recording {

// Writes a recording on its own thread, so that the caller never waits for the disk. Used by one thread.
class BackgroundWriter {
  public:
    // Same as Writer::create with a random id, and Refused if there is no memory for the queue. The recording ends with
    // a failure when it reaches `mostBytes`; 0: no limit.
    static Result<std::unique_ptr<BackgroundWriter>> create(const std::string& path, bool replace,
                                                            std::uint64_t mostBytes);
    ~BackgroundWriter();  // finishes the recording and waits for the thread
    BackgroundWriter(const BackgroundWriter&) = delete;
    BackgroundWriter& operator=(const BackgroundWriter&) = delete;

    // Queues a record, see Writer::add. Returns false when the queue is full and the record is dropped. Scene, order
    // and settings are never dropped; the recording ends when they need too much memory.
    [[nodiscard]] bool add(Kind kind, double time, codec::SharedMessage message);
    // Queues bytes of a command log. May be called by any thread, which waits while the queue is full. After
    // beginLog() the recording does not end before endLog(), except by an error or its limit: then the bytes are
    // dropped, and it returns false.
    bool addLog(std::string_view bytes);
    void beginLog();
    void endLog();
    // Ends the recording after the queued records.
    void finish();
    void wait();  // until the recording has ended

    struct Progress {
        std::uint64_t bytes = 0;
        std::uint64_t frames = 0;
        bool ended = false;   // nothing more is written
        std::string failure;  // why it ended before finish(); empty: it did not
    };
    [[nodiscard]] Progress progress();

  private:
    struct Item {
        Kind kind;
        double time;                   // not of a log
        codec::SharedMessage message;  // null: a log
        std::string log;

        [[nodiscard]] const std::string& bytes() const { return message ? message->binary() : log; }
    };

    BackgroundWriter(Writer writer, std::uint64_t mostBytes, memory::Claim queue);
    void write();
    Result<bool> waitForItems(std::vector<Item>& items);
    Result<void> writeItems(const std::vector<Item>& items);
    void end(const Result<void>& done);

    const memory::Claim queue_;
    Writer writer_;  // used by the thread
    const std::uint64_t mostBytes_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> waiting_;
    std::size_t waitingBytes_ = 0;
    bool finishing_ = false;
    bool logging_ = false;
    Progress progress_;
    std::jthread thread_;
};

}  // namespace spherule::recording
