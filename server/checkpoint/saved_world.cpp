#include "checkpoint/saved_world.h"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/heartbeat.h"
#include "recording/bytes.h"
#include "sim/array.h"

namespace spherule::checkpoint {

namespace {

using recording::append;
using recording::numberAt;

constexpr std::size_t chunkBytes = 1U << 24U;  // of data in a record, before it is compressed
constexpr std::size_t partHeadBytes = 8;       // number of the part, size of the data
constexpr std::uint64_t mostStateBytes = std::uint64_t{1} << 44U;
constexpr std::size_t mostHeadBytes = 1U << 20U;  // parsed, a message takes a multiple of them
constexpr int level = 1;                          // of zstd: fast

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

// Writes the data of a part in chunks.
class PartWriter {
  public:
    PartWriter(Position& position, const WriteBytes& bytes) : position_(position), write_(bytes) {}

    Result<void> write(std::uint32_t part, std::span<const std::byte> data) {
        for (std::size_t begin = 0; begin < data.size(); begin += chunkBytes) {
            const auto chunk = data.subspan(begin, std::min(chunkBytes, data.size() - begin));
            std::string payload;
            append(payload, part);
            append(payload, static_cast<std::uint32_t>(chunk.size()));
            payload.resize(partHeadBytes + ZSTD_compressBound(chunk.size()));
            const std::size_t size =
                ZSTD_compressCCtx(context_.get(), payload.data() + partHeadBytes, payload.size() - partHeadBytes,
                                  chunk.data(), chunk.size(), level);
            if (ZSTD_isError(size) != 0) return fail(ErrorKind::Refused, "", "there is not enough memory to compress");
            payload.resize(partHeadBytes + size);
            if (auto done = write_(recordBytes(Kind::Part, payload, position_)); !done) return done;
        }
        return {};
    }

  private:
    Position& position_;
    const WriteBytes& write_;
    std::unique_ptr<ZSTD_CCtx, FreeContext> context_{ZSTD_createCCtx()};
};

// Appends the data of the next record to a part that has `bytes` in all.
Result<void> appendChunk(RecordReader& reader, std::uint32_t part, std::uint64_t bytes, std::string& data) {
    const auto record = reader.next();
    if (!record) return tl::unexpected(record.error());
    if (!*record) return reader.bad("is missing: the file is cut off");
    const std::string& payload = (*record)->payload;
    if ((*record)->kind != Kind::Part || payload.size() < partHeadBytes || numberAt<std::uint32_t>(payload, 0) != part)
        return reader.bad("before it is not the part of the state that has to come");
    const std::size_t size = numberAt<std::uint32_t>(payload, sizeof(std::uint32_t));
    const std::size_t done = data.size();
    if (size == 0 || size > chunkBytes || size > bytes - done) return reader.bad("before it has too much data");
    data.resize(done + size);
    const std::size_t got =
        ZSTD_decompress(data.data() + done, size, payload.data() + partHeadBytes, payload.size() - partHeadBytes);
    if (got != size) return reader.bad("before it cannot be decompressed");
    return {};
}

Result<std::string> readPart(RecordReader& reader, std::uint32_t part, std::uint64_t bytes) {
    std::string data;
    while (data.size() < bytes)
        if (auto done = appendChunk(reader, part, bytes, data); !done) return tl::unexpected(done.error());
    return data;
}

}  // namespace

Result<void> write(SavedWorld world, Position& position, const WriteBytes& bytes) {
    v1::StateHead head = std::move(world.head);
    std::random_device random;
    head.set_id((std::uint64_t{random()} << 32U) | random());
    head.set_host_bytes(world.state.host.size());
    for (const sim::Pipeline::SavedArray& array : world.state.arrays) {
        v1::StateArray& one = *head.add_arrays();
        one.set_name(std::string(sim::nameOf(array.array)));
        one.set_bytes(array.bytes.size());
    }
    if (auto done = bytes(recordBytes(Kind::State, head.SerializeAsString(), position)); !done) return done;
    PartWriter parts(position, bytes);
    if (auto done = parts.write(0, std::as_bytes(std::span(world.state.host))); !done) return done;
    for (std::uint32_t k = 0; k < world.state.arrays.size(); ++k) {
        const std::vector<std::byte> data = std::move(world.state.arrays[k].bytes);
        if (auto done = parts.write(k + 1, data); !done) return done;
    }
    return bytes(recordBytes(Kind::End, "", position));
}

Result<v1::StateHead> readHead(RecordReader& reader) {
    const auto record = reader.next();
    if (!record) return tl::unexpected(record.error());
    if (!*record) return reader.bad("is missing: the file is cut off");
    v1::StateHead head;
    const std::string& payload = (*record)->payload;
    if ((*record)->kind != Kind::State || payload.size() > mostHeadBytes || !head.ParseFromString(payload))
        return reader.bad("before it is not the head of a state");
    return head;
}

Result<SavedWorld> readWorld(RecordReader& reader) {
    const heartbeat::Pause reading;
    auto head = readHead(reader);
    if (!head) return tl::unexpected(head.error());
    SavedWorld world{.head = std::move(*head), .state = {}};
    std::uint64_t bytes = world.head.host_bytes();
    if (bytes > mostStateBytes) return reader.bad("before it names too much data");
    for (const v1::StateArray& array : world.head.arrays()) {
        if (array.bytes() > mostStateBytes - bytes) return reader.bad("before it names too much data");
        bytes += array.bytes();
    }
    auto claim = memory::Claim::make(reader.path(), "a saved state", bytes);
    if (!claim) return tl::unexpected(claim.error());
    world.state.claim = std::move(*claim);
    auto host = readPart(reader, 0, world.head.host_bytes());
    if (!host) return tl::unexpected(host.error());
    world.state.host = std::move(*host);
    for (int k = 0; k < world.head.arrays_size(); ++k) {
        const v1::StateArray& named = world.head.arrays(k);
        const auto array = sim::arrayNamed(named.name());
        if (!array) return reader.bad("before it names an array that this version of the program does not have");
        const auto data = readPart(reader, static_cast<std::uint32_t>(k + 1), named.bytes());
        if (!data) return tl::unexpected(data.error());
        const auto part = std::as_bytes(std::span(*data));
        world.state.arrays.push_back({.array = *array, .bytes = {part.begin(), part.end()}});
    }
    const auto end = reader.next();
    if (!end) return tl::unexpected(end.error());
    if (!*end || (*end)->kind != Kind::End) return reader.bad("is not the end of the state: the file is cut off");
    world.head.clear_arrays();
    world.head.clear_host_bytes();
    world.head.clear_id();
    return world;
}

Result<SavedWorld> readCheckpoint(const std::string& path) {
    auto reader = RecordReader::open(path, FileKind::Checkpoint);
    if (!reader) return tl::unexpected(reader.error());
    auto world = readWorld(*reader);
    if (!world) return world;
    if (reader->position().bytes != reader->size()) return reader->bad("comes after the end of the state");
    return world;
}

}  // namespace spherule::checkpoint
