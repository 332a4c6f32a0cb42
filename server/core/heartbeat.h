#pragma once

#include <cstdint>

// Signs of life of the thread that computes, for whoever watches it. Any thread; costs less than a kernel's launch.
namespace spherule::heartbeat {

// A part of the work is done; what comes now is `doing` (a literal: "waiting for the device").
void beat(const char* doing);

// While one is there no sign is expected: a file of any size is read or written.
class Pause {
  public:
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;
};

struct Sign {
    std::uint64_t beats = 0;
    const char* doing = "starting";
    bool expected = true;
};
[[nodiscard]] Sign last();

}  // namespace spherule::heartbeat
