#include "compute/cpu/pool.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace spherule::compute::cpu {
namespace {

constexpr std::uint64_t open = 1;
constexpr std::uint64_t inside = 2;
constexpr unsigned numberShift = 32;
constexpr std::uint64_t insideMask = (std::uint64_t{1} << numberShift) - 1 - open;
constexpr unsigned patienceAlone = 2000;  // about 50 us, longer than the gaps between the runs of a substep
constexpr unsigned patienceCrowded = 20;  // more threads than processors: a spinning thread keeps another from working

void pause() {
#if defined(__x86_64__)
    _mm_pause();
#else
    std::this_thread::yield();
#endif
}

}  // namespace

Pool::Pool(unsigned threads) : shares_(std::make_unique<Share[]>(threads)) {
    patience_ = threads <= std::thread::hardware_concurrency() ? patienceAlone : patienceCrowded;
    try {
        for (unsigned self = 1; self < threads; ++self) workers_.emplace_back([this, self] { serve(self); });
    } catch (...) {
        stop();
        throw;
    }
}

Pool::~Pool() {
    stop();
}

void Pool::stop() {
    stop_ = true;
    gate_ += std::uint64_t{1} << numberShift;
    gate_.notify_all();
}

void Pool::run(std::uint32_t count, std::uint32_t grain, Body body, const void* context) {
    if (workers_.empty() || count <= grain) {
        if (count > 0) body(context, 0, count);
        return;
    }
    body_ = body;
    context_ = context;
    grain_ = grain;
    const std::uint64_t total = threads();
    for (std::uint64_t k = 0; k < total; ++k) {
        shares_[k].next.store(static_cast<std::uint32_t>(count * k / total), std::memory_order_relaxed);
        shares_[k].end = static_cast<std::uint32_t>(count * (k + 1) / total);
    }
    const std::uint64_t number = (gate_.load(std::memory_order_relaxed) >> numberShift) + 1;
    gate_.store((number << numberShift) | open, std::memory_order_release);
    gate_.notify_all();
    work(0);
    close();
}

// Closes the gate and waits for the workers inside.
void Pool::close() {
    std::uint64_t state = gate_.fetch_sub(open, std::memory_order_acq_rel);
    for (unsigned looks = 0; (state & insideMask) != 0; ++looks) {
        if (looks < patience_)
            pause();
        else
            std::this_thread::yield();
        state = gate_.load(std::memory_order_acquire);
    }
}

void Pool::work(unsigned self) {
    const unsigned total = threads();
    for (unsigned k = 0; k < total; ++k) {
        Share& share = shares_[(self + k) % total];
        for (;;) {
            const std::uint32_t begin = share.next.fetch_add(grain_, std::memory_order_relaxed);
            if (begin >= share.end) break;
            body_(context_, begin, std::min(begin + grain_, share.end));
        }
    }
}

void Pool::serve(unsigned self) {
    std::uint64_t done = 0;
    unsigned looks = 0;
    for (;;) {
        // The order matters: a worker that sees the gate as stop() left it also sees `stop_`, and does not wait for
        // another change.
        std::uint64_t state = gate_.load(std::memory_order_acquire);
        if (stop_) return;
        const std::uint64_t number = state >> numberShift;
        if ((state & open) != 0 && number != done) {
            if (!gate_.compare_exchange_weak(state, state + inside, std::memory_order_acq_rel)) continue;
            work(self);
            gate_.fetch_sub(inside, std::memory_order_release);
            done = number;
            looks = 0;
        } else if (++looks < patience_) {
            pause();
        } else {
            gate_.wait(state, std::memory_order_acquire);
        }
    }
}

}  // namespace spherule::compute::cpu
