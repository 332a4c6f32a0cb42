#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Constants of docs/recordings.md.
namespace spherule::recording {

constexpr std::array<unsigned char, 8> fileMagic = {'S', 'P', 'H', 'R', 'E', 'C', '\r', '\n'};
constexpr std::array<unsigned char, 8> endMagic = {'S', 'P', 'H', 'E', 'N', 'D', '\r', '\n'};
constexpr std::uint32_t formatVersion = 2;  // written
constexpr std::uint32_t oldestVersion = 1;  // read, as all versions up to formatVersion

// Kind of a record, so that a reader can skip records without parsing them.
enum class Kind : std::uint32_t {
    Scene = 1,     // SceneFacts of the frames that follow
    Order = 2,     // Order of the frames that follow
    Settings = 3,  // Settings from here on
    Other = 4,     // welcome, event, diagnostics, ...; not needed by frames
    Keyframe = 5,  // a frame that starts a chain
    Resync = 6,    // the previous frame as a keyframe, for readers that start here
    Delta = 7,     // a frame that needs the previous one
    Index = 8,     // index of the file; the last record
    Log = 9,       // bytes of a command log; from version 2 on
};

constexpr bool isKnown(Kind kind, std::uint32_t version) {
    return kind >= Kind::Scene && kind <= (version == 1 ? Kind::Index : Kind::Log);
}
constexpr bool isFrame(Kind kind) {
    return kind == Kind::Keyframe || kind == Kind::Delta;
}
// Returns true for records where a reader can start, or that it needs before it starts.
constexpr bool isIndexed(Kind kind) {
    return kind == Kind::Scene || kind == Kind::Order || kind == Kind::Settings || kind == Kind::Keyframe ||
           kind == Kind::Resync;
}

// Bytes.
constexpr std::size_t fileHeadBytes = 16;    // magic, version, id
constexpr std::size_t recordHeadBytes = 16;  // length of the payload, kind, time
constexpr std::size_t checksumBytes = 8;
constexpr std::size_t entryBytes = 24;      // offset, time, kind, 0
constexpr std::size_t indexHeadBytes = 24;  // frames, time of the first, time of the last
constexpr std::size_t trailerBytes = 16;    // offset of the index, magic
constexpr std::uint32_t mostPayload = 1U << 30U;

}  // namespace spherule::recording
