#pragma once

#include <cstdint>

// Heartbeat of the simulation thread, read by the watchdog. Any thread. A beat costs less than a kernel launch.
namespace spherule::heartbeat {

// Reports progress. `doing`: the next part of the work, a string literal such as "waiting for the device".
void beat(const char* doing);

// While a Pause exists, the watchdog expects no beats: for work of any length, such as reading a file.
class Pause {
  public:
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;
};

struct Status {
    std::uint64_t beats = 0;
    const char* doing = "starting";
    bool expected = true;
};
[[nodiscard]] Status status();

}  // namespace spherule::heartbeat
