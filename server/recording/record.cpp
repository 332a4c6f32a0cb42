#include "recording/record.h"

#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "recording/bytes.h"

namespace spherule::recording {

std::string recordBytes(Kind kind, double time, std::string_view payload) {
    std::string bytes;
    bytes.reserve(recordHeadBytes + payload.size() + checksumBytes);
    append(bytes, static_cast<std::uint32_t>(payload.size()));
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, time);
    bytes += payload;
    append(bytes, std::uint64_t{XXH3_64bits(bytes.data(), bytes.size())});
    return bytes;
}

std::string fileHead() {
    std::string bytes(fileMagic.begin(), fileMagic.end());
    append(bytes, formatVersion);
    append(bytes, std::uint32_t{0});
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
    if (const auto version = numberAt<std::uint32_t>(head, fileMagic.size()); version != formatVersion)
        return no(fmt::format("is of version {} of the format, this program reads version {}", version, formatVersion));
    if (numberAt<std::uint32_t>(head, fileMagic.size() + 4) != 0) return no("is no recording: its head is damaged");
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
    if (record.kind < Kind::Scene || record.kind > Kind::Index || !std::isfinite(record.time))
        return bad(offset, "is damaged: its head is invalid");
    return record;
}

Result<Record> RecordFile::read(std::uint64_t offset) const {
    auto record = readHead(offset);
    if (!record) return record;
    std::string bytes(record->end - offset, '\0');
    if (!get(offset, bytes.data(), bytes.size())) return bad(offset, "cannot be read");
    const std::size_t hashed = bytes.size() - checksumBytes;
    if (numberAt<std::uint64_t>(bytes, hashed) != XXH3_64bits(bytes.data(), hashed))
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
