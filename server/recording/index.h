#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "recording/record.h"

namespace spherule::recording {

// Where in a recording one can begin, and what must be known there.
struct Index {
    struct Entry {
        std::uint64_t offset = 0;  // of the record
        double time = 0;           // s simulated
        Kind kind = Kind::Keyframe;
    };

    std::uint64_t frames = 0;
    double begin = 0, end = 0;  // times of the first and the last frame, s simulated
    std::vector<Entry> entries;

    // Takes the next record of the file in.
    void add(Kind kind, double time, std::uint64_t offset);
    [[nodiscard]] std::string payload() const;

    // Of a file's index record that begins at `offset`; Input for one that cannot be.
    static Result<Index> from(std::string_view payload, std::uint64_t offset);
};

// What there is to play in a file.
struct Contents {
    Index index;
    std::uint64_t end = 0;  // where its records end, but for the index
    std::string damage;     // why that is not the end that a finished recording has; empty: it is
};

// From the index; where there is none, from reading all the records up to the first that is cut off or damaged.
Contents contentsOf(const RecordFile& file);

}  // namespace spherule::recording
