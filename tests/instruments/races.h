// Finds data races between the invocations of a launch. The kernels are compiled with -fsanitize=thread, and the hooks
// that the compiler inserts before each access lead here. Two accesses to a word race if they come from two invocations
// of a launch, one of them writes, and they are not both atomic. In a work group, a barrier between them orders
// accesses to its variables, and BUFFER_BARRIER also those to coherent buffers.
//
// Nothing depends on the order in which invocations run: each race that the input can cause is found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace spherule::instruments {

struct Race {
    std::string kernel;
    std::string buffer;       // "" for a variable of the work group
    std::string kind;         // of the accesses: "read, write"
    bool inGroup = false;     // between threads of one work group
    std::uint32_t first = 0;  // invocations, work groups, or threads of one work group
    std::uint32_t second = 0;
    std::uint32_t group = 0;  // of the threads
    std::uint64_t word = 0;   // of the buffer
    std::uint64_t count = 0;  // of such races in the kernel and the buffer

    [[nodiscard]] std::string text() const;  // a sentence
};

// Returns the races since the last call, one for each kernel, buffer and kind. Also reads of a variable of a work group
// that none of its threads has written.
std::vector<Race> takeRaces();

// The bytes that the launches of a kernel move between a buffer and the memory. A cache holds everything that one
// launch accesses, but nothing from one launch to the next. Sectors are the parts of 32 bytes that memory moves.
struct Traffic {
    std::string kernel;
    std::string buffer;
    std::uint64_t bytesRead = 0;  // of words that a launch reads before it writes them, each once
    std::uint64_t bytesWritten = 0;
    std::uint64_t sectorBytesRead = 0;
    std::uint64_t sectorBytesWritten = 0;
};

// Returns the traffic since the last call, one for each kernel and buffer.
std::vector<Traffic> takeTraffic();

// Accesses of kernels to buffers and variables of work groups since the program began.
std::uint64_t accesses();

}  // namespace spherule::instruments
