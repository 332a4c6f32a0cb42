#include "cli/interrupt.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

#include "cli/exit_codes.h"

namespace spherule::cli {

namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

std::array<struct sigaction, signals.size()> before{};
std::atomic<bool> finishes = false;
std::atomic<int> askedBy = 0;
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<int>::is_always_lock_free);  // required in a signal handler

void handle(int signal) {
    if (!finishes) _exit(exitBySignal + signal);
    int none = 0;
    if (askedBy.compare_exchange_strong(none, signal)) return;
    // A closing terminal may send SIGHUP several times.
    if (signal != SIGHUP) _exit(exitBySignal + signal);
}

}  // namespace

Interrupt::Interrupt() {
    finishes = false;
    askedBy = 0;
    struct sigaction action {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    for (std::size_t k = 0; k < signals.size(); ++k) {
        sigaction(signals[k], nullptr, &before[k]);
        if (before[k].sa_handler != SIG_IGN) sigaction(signals[k], &action, nullptr);
    }
}

Interrupt::~Interrupt() {
    for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &before[k], nullptr);
}

void Interrupt::finishFirst() {
    finishes = true;
}

int Interrupt::signal() const {
    return askedBy;
}

const char* Interrupt::name() const {
    return signal() == SIGINT ? "SIGINT" : signal() == SIGTERM ? "SIGTERM" : "SIGHUP";
}

}  // namespace spherule::cli
