#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// The constants of docs/recordings.md.
namespace spherule::recording {

constexpr std::array<unsigned char, 8> fileMagic = {'S', 'P', 'H', 'R', 'E', 'C', '\r', '\n'};
constexpr std::array<unsigned char, 8> endMagic = {'S', 'P', 'H', 'E', 'N', 'D', '\r', '\n'};
constexpr std::uint32_t formatVersion = 1;

// What a record is, so that a reader finds its way without parsing what it does not need.
enum class Kind : std::uint32_t {
    Scene = 1,     // SceneFacts: of the frames that follow
    Order = 2,     // likewise
    Settings = 3,  // as they are from here on
    Other = 4,     // welcome, event, diagnostics, ...: nothing that a frame needs
    Keyframe = 5,  // a frame with which the chain begins
    Resync = 6,    // the frame before once more, as a keyframe: for who begins here
    Delta = 7,     // a frame that needs the one before
    Index = 8,     // of the whole file; the last record
};

constexpr bool isFrame(Kind kind) {
    return kind == Kind::Keyframe || kind == Kind::Delta;
}
// Where a reader can begin, or what it must know of before it does.
constexpr bool isIndexed(Kind kind) {
    return kind == Kind::Scene || kind == Kind::Order || kind == Kind::Settings || kind == Kind::Keyframe ||
           kind == Kind::Resync;
}

// Bytes.
constexpr std::size_t fileHeadBytes = 16;    // magic, version, 0
constexpr std::size_t recordHeadBytes = 16;  // length of the payload, kind, time
constexpr std::size_t checksumBytes = 8;
constexpr std::size_t entryBytes = 24;      // offset, time, kind, 0
constexpr std::size_t indexHeadBytes = 24;  // frames, time of the first, time of the last
constexpr std::size_t trailerBytes = 16;    // offset of the index, magic
constexpr std::uint32_t mostPayload = 1U << 30U;

}  // namespace spherule::recording
