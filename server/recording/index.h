#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "recording/record.h"

namespace spherule::recording {

// Records of a recording where a reader can start, or that it needs to start.
struct Index {
    struct Entry {
        std::uint64_t offset = 0;  // of the record
        double time = 0;           // s simulated
        Kind kind = Kind::Keyframe;
    };

    std::uint64_t frames = 0;
    double begin = 0, end = 0;  // times of the first and the last frame, s simulated
    std::vector<Entry> entries;

    // Adds the next record of the file.
    void add(Kind kind, double time, std::uint64_t offset);
    [[nodiscard]] std::string payload() const;

    // Parses an index record that begins at `offset`. Input if it is invalid.
    static Result<Index> from(std::string_view payload, std::uint64_t offset);
};

// The playable part of a file.
struct Contents {
    Index index;
    std::uint64_t end = 0;  // end of the records before the index
    std::string damage;     // why the file is incomplete; empty: it is complete
};

// Reads the index. If there is none, reads all records up to the first that is cut off or damaged.
Contents contentsOf(const RecordFile& file);

}  // namespace spherule::recording
