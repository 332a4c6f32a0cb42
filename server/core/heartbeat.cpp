#include "core/heartbeat.h"

#include <atomic>

namespace spherule::heartbeat {

namespace {

std::atomic<std::uint64_t> beats = 0;
std::atomic<const char*> work = Status().doing;
std::atomic<int> unwatched = 0;

}  // namespace

void beat(const char* doing) {
    work.store(doing, std::memory_order_relaxed);
    beats.fetch_add(1, std::memory_order_relaxed);
}

Pause::Pause() {
    ++unwatched;
}
Pause::~Pause() {
    --unwatched;
}

Status status() {
    return {.beats = beats.load(std::memory_order_relaxed),
            .doing = work.load(std::memory_order_relaxed),
            .expected = unwatched == 0};
}

}  // namespace spherule::heartbeat
