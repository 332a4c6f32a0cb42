#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "codec/message.h"
#include "core/memory.h"
#include "core/result.h"
#include "recording/writer.h"

namespace spherule::recording {

// Writes a recording on a thread of its own, so that who records never waits for a disk. Used by one thread.
class BackgroundWriter {
  public:
    // As Writer::create, and refused where there is no memory for what waits. The recording ends, and says so, where it
    // has `mostBytes`; 0: it may have any.
    static Result<std::unique_ptr<BackgroundWriter>> create(const std::string& path, bool replace,
                                                            std::uint64_t mostBytes);
    ~BackgroundWriter();  // finishes it, and waits for that
    BackgroundWriter(const BackgroundWriter&) = delete;
    BackgroundWriter& operator=(const BackgroundWriter&) = delete;

    // As Writer::add. False where the record is left out, because very much still waits to be written. What frames need
    // is never left out: where that would take up too much memory, the recording ends.
    [[nodiscard]] bool add(Kind kind, double time, codec::SharedMessage message);
    // No record follows.
    void finish();
    void wait();  // until all is written that will be

    struct Progress {
        std::uint64_t bytes = 0;
        std::uint64_t frames = 0;
        bool ended = false;   // nothing is written any more
        std::string failure;  // why it has ended before finish(); empty: it has not
    };
    [[nodiscard]] Progress progress();

  private:
    struct Item {
        Kind kind;
        double time;
        codec::SharedMessage message;
    };

    BackgroundWriter(Writer writer, std::uint64_t mostBytes, memory::Claim queue);
    void write();
    Result<bool> take(std::vector<Item>& items);
    Result<void> put(const std::vector<Item>& items);
    void end(const Result<void>& done);

    const memory::Claim queue_;
    Writer writer_;  // of the thread
    const std::uint64_t mostBytes_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> waiting_;
    std::size_t waitingBytes_ = 0;
    bool finishing_ = false;
    Progress progress_;
    std::jthread thread_;
};

}  // namespace spherule::recording
