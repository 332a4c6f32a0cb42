#include "recording/record.h"

#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "recording/bytes.h"

namespace spherule::recording {

std::string FileHead::bytes() const {
    std::string bytes(fileMagic.begin(), fileMagic.end());
    append(bytes, version);
    append(bytes, id);
    return bytes;
}

std::uint32_t fileIdOf(std::string_view content) {
    return static_cast<std::uint32_t>(XXH3_64bits(content.data(), content.size()));
}

std::uint32_t randomFileId() {
    return std::random_device()();
}

// In version 1 a record has the same checksum at each place of each file.
std::uint64_t checksumOf(std::string_view record, const FileHead& file, std::uint64_t offset) {
    const std::uint64_t own = XXH3_64bits(record.data(), record.size());
    if (file.version == 1) return own;
    std::string placed;
    append(placed, own);
    append(placed, offset);
    append(placed, file.id);
    return XXH3_64bits(placed.data(), placed.size());
}

std::string recordBytes(Kind kind, double time, std::string_view payload, const FileHead& file, std::uint64_t offset) {
    std::string bytes;
    bytes.reserve(recordHeadBytes + payload.size() + checksumBytes);
    append(bytes, static_cast<std::uint32_t>(payload.size()));
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, time);
    bytes += payload;
    append(bytes, checksumOf(bytes, file, offset));
    return bytes;
}

Result<RecordFile> RecordFile::open(const std::string& path) {
    const auto no = [&](const std::string& what) { return fail(ErrorKind::Input, path, what); };
    auto opened = InputFile::open(path);
    if (!opened) return tl::unexpected(opened.error());
    RecordFile file(std::move(*opened));
    std::string head(fileHeadBytes, '\0');
    if (!file.get(0, head.data(), head.size()))
        return no(fmt::format("is no recording: it has only {} bytes", file.size()));
    if (std::memcmp(head.data(), fileMagic.data(), fileMagic.size()) != 0)
        return no("is no recording: it does not begin like one");
    file.head_.version = numberAt<std::uint32_t>(head, fileMagic.size());
    file.head_.id = numberAt<std::uint32_t>(head, fileMagic.size() + 4);
    const auto& [version, id] = file.head_;
    if (version > formatVersion)
        return no(
            fmt::format("is of version {} of the format; this program, spherule {}, reads versions {} and {}: "
                        "use a newer spherule",
                        version, SPHERULE_VERSION, oldestVersion, formatVersion));
    if (version < oldestVersion || (version == 1 && id != 0)) return no("is no recording: its head is damaged");
    return file;
}

bool RecordFile::get(std::uint64_t offset, char* bytes, std::size_t count) const {
    if (offset > size() || count > size() - offset) return false;
    const auto got = file_.read(offset, bytes, count);
    return got && *got == count;
}

tl::unexpected<Error> RecordFile::bad(std::uint64_t offset, const std::string& what) const {
    return fail(ErrorKind::Input, path(), fmt::format("the record at byte {} {}", offset, what));
}

Result<Record> RecordFile::readHead(std::uint64_t offset) const {
    std::string head(recordHeadBytes, '\0');
    if (!get(offset, head.data(), head.size())) return bad(offset, "is cut off");
    const auto length = numberAt<std::uint32_t>(head, 0);
    const std::uint64_t whole = recordHeadBytes + std::uint64_t{length} + checksumBytes;
    if (length > mostPayload) return bad(offset, "is damaged: it is too long");
    if (whole > size() - offset) return bad(offset, "is cut off");
    Record record{.kind = static_cast<Kind>(numberAt<std::uint32_t>(head, 4)),
                  .time = numberAt<double>(head, 8),
                  .payload = {},
                  .end = offset + whole};
    if (!isKnown(record.kind, head_.version) || !std::isfinite(record.time))
        return bad(offset, "is damaged: its head is invalid");
    return record;
}

Result<Record> RecordFile::read(std::uint64_t offset) const {
    auto record = readHead(offset);
    if (!record) return record;
    std::string bytes(record->end - offset, '\0');
    if (!get(offset, bytes.data(), bytes.size())) return bad(offset, "cannot be read");
    const std::size_t hashed = bytes.size() - checksumBytes;
    if (numberAt<std::uint64_t>(bytes, hashed) != checksumOf({bytes.data(), hashed}, head_, offset))
        return bad(offset, "is damaged: its checksum differs");
    bytes.resize(hashed);
    bytes.erase(0, recordHeadBytes);
    record->payload = std::move(bytes);
    return record;
}

std::uint64_t RecordFile::indexOffset() const {
    if (size() < fileHeadBytes + trailerBytes) return 0;
    std::string trailer(trailerBytes, '\0');
    if (!get(size() - trailerBytes, trailer.data(), trailer.size())) return 0;
    if (std::memcmp(trailer.data() + sizeof(std::uint64_t), endMagic.data(), endMagic.size()) != 0) return 0;
    return numberAt<std::uint64_t>(trailer, 0);
}

}  // namespace spherule::recording
