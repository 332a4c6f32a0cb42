#include "checkpoint/record_chain.h"

#include <xxhash.h>

#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/input_file.h"
#include "recording/bytes.h"
#include "recording/carried_log.h"

namespace spherule::checkpoint {

namespace {

using recording::append;
using recording::numberAt;

constexpr std::array<std::string_view, 2> magics{"SPHCKPT\n", "SPHCLOG\n"};
constexpr std::array<const char*, 2> names{"checkpoint", "command log"};
constexpr std::size_t versionBytes = 24;  // the program's version, filled up with zeros
constexpr std::size_t headBytes = magicBytes + sizeof(std::uint32_t) + versionBytes;
constexpr std::size_t recordHeadBytes = 8;  // kind, length of the payload
constexpr std::size_t checksumBytes = 8;

static_assert(std::string_view(SPHERULE_VERSION).size() < versionBytes);

}  // namespace

std::string headOf(FileKind kind) {
    std::string head(magics.at(static_cast<std::size_t>(kind)));
    append(head, formatVersion);
    head += SPHERULE_VERSION;
    head.resize(headBytes);
    return head;
}

Position positionAfter(std::string_view head) {
    return {.bytes = head.size(), .chain = XXH3_64bits(head.data(), head.size())};
}

std::string recordBytes(Kind kind, std::string_view payload, Position& position) {
    std::string bytes;
    bytes.reserve(recordHeadBytes + payload.size() + checksumBytes);
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, static_cast<std::uint32_t>(payload.size()));
    bytes += payload;
    position.chain = XXH3_64bits_withSeed(bytes.data(), bytes.size(), position.chain);
    append(bytes, position.chain);
    position.bytes += bytes.size();
    return bytes;
}

Result<RecordReader> RecordReader::openBytes(const std::string& path, FileKind kind) {
    if (kind == FileKind::CommandLog && recording::isRecording(path)) {
        auto carried = recording::CarriedLog::open(path);
        if (!carried) return tl::unexpected(carried.error());
        const auto log = std::make_shared<recording::CarriedLog>(std::move(*carried));
        RecordReader reader(
            path + " (its log)", log->size(),
            [log](std::uint64_t offset, char* bytes, std::size_t count) { return log->read(offset, bytes, count); });
        reader.flaw_ = log->flaw();
        return reader;
    }
    auto opened = InputFile::open(path);
    if (!opened) return tl::unexpected(opened.error());
    const auto file = std::make_shared<InputFile>(std::move(*opened));
    return RecordReader(path, file->size(), [file](std::uint64_t offset, char* bytes, std::size_t count) {
        return file->read(offset, bytes, count);
    });
}

Result<RecordReader> RecordReader::open(const std::string& path, FileKind kind) {
    const char* const name = names.at(static_cast<std::size_t>(kind));
    auto opened = openBytes(path, kind);
    if (!opened) return opened;
    RecordReader reader = std::move(*opened);
    const auto no = [&](const std::string& what) { return fail(ErrorKind::Input, path, what); };
    if (reader.size() < headBytes) return no(fmt::format("is no {}: it has only {} bytes", name, reader.size()));
    const auto head = reader.bytes(0, headBytes);
    if (!head) return tl::unexpected(head.error());
    if (!head->starts_with(magics.at(static_cast<std::size_t>(kind))))
        return no(fmt::format("is no {}: it does not begin like one", name));
    const std::string version = head->substr(magicBytes + sizeof(std::uint32_t));
    reader.program_ = version.substr(0, version.find('\0'));
    for (const char letter : reader.program_)
        if (letter < '!' || letter > '~') return no(fmt::format("is no {}: its head is damaged", name));
    if (const auto format = numberAt<std::uint32_t>(*head, magicBytes); format != formatVersion)
        return no(
            fmt::format("has format {} of a {}; this program, {}, reads format {}. Use spherule {}, which wrote it",
                        format, name, SPHERULE_VERSION, formatVersion, reader.program_));
    reader.position_ = positionAfter(*head);
    return reader;
}

tl::unexpected<Error> RecordReader::bad(const std::string& what) const {
    return fail(ErrorKind::Input, path(), fmt::format("the record at byte {} {}", position_.bytes, what));
}

Result<std::string> RecordReader::bytes(std::uint64_t offset, std::size_t count) const {
    std::string bytes(count, '\0');
    const auto got = read_(offset, bytes.data(), count);
    if (!got) return tl::unexpected(got.error());
    if (*got < count) return bad("is cut off");
    return bytes;
}

Result<std::optional<Record>> RecordReader::next() {
    const std::uint64_t left = size() - position_.bytes;
    if (left == 0 && flaw_) return tl::unexpected(*flaw_);
    if (left == 0) return std::nullopt;
    if (left < recordHeadBytes + checksumBytes) return bad("is cut off");
    const auto head = bytes(position_.bytes, recordHeadBytes);
    if (!head) return tl::unexpected(head.error());
    const auto length = numberAt<std::uint32_t>(*head, sizeof(std::uint32_t));
    if (length > mostPayload) return bad("is damaged: it is too long");
    const std::size_t whole = recordHeadBytes + std::size_t{length} + checksumBytes;
    if (whole > left) return bad("is cut off");
    auto all = bytes(position_.bytes, whole);
    if (!all) return tl::unexpected(all.error());
    const std::uint64_t chain = XXH3_64bits_withSeed(all->data(), whole - checksumBytes, position_.chain);
    if (numberAt<std::uint64_t>(*all, whole - checksumBytes) != chain) return bad("is damaged: its checksum differs");
    const auto kind = static_cast<Kind>(numberAt<std::uint32_t>(*all, 0));
    if (kind < Kind::State || kind > Kind::Entry) return bad("is damaged: it has no kind");
    position_ = {.bytes = position_.bytes + whole, .chain = chain};
    return Record{.kind = kind, .payload = all->substr(recordHeadBytes, length)};
}

}  // namespace spherule::checkpoint
