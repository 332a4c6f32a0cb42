#include "record_bytes.h"

#include <cstdint>

#include "recording/bytes.h"
#include "recording/record.h"

namespace spherule::recording {

namespace {

FileHead headOf(std::string_view file) {
    return {.version = numberAt<std::uint32_t>(file, fileMagic.size()),
            .id = numberAt<std::uint32_t>(file, fileMagic.size() + sizeof(std::uint32_t))};
}

}  // namespace

std::optional<std::size_t> endOfRecord(std::string_view file, std::size_t at) {
    constexpr std::size_t frame = recordHeadBytes + checksumBytes;
    if (at > file.size() || file.size() - at < frame) return std::nullopt;
    const auto payload = numberAt<std::uint32_t>(file, at);
    if (payload > file.size() - at - frame) return std::nullopt;
    return at + frame + payload;
}

std::vector<std::string> recordsOf(std::string_view file) {
    std::vector<std::string> records;
    std::size_t at = fileHeadBytes;
    while (const auto end = endOfRecord(file, at)) {
        records.emplace_back(file.substr(at, *end - at));
        at = *end;
    }
    return records;
}

Kind kindOf(std::string_view record) {
    return static_cast<Kind>(numberAt<std::uint32_t>(record, 4));
}

double timeOf(std::string_view record) {
    return numberAt<double>(record, 8);
}

std::string_view payloadOf(std::string_view record) {
    return record.substr(recordHeadBytes, record.size() - recordHeadBytes - checksumBytes);
}

void addRecord(std::string& file, Kind kind, double time, std::string_view payload) {
    file += recordBytes(kind, time, payload, headOf(file), file.size());
}

void setChecksums(std::string& file) {
    std::size_t at = fileHeadBytes;
    while (const auto end = endOfRecord(file, at)) {
        const std::size_t hashed = *end - checksumBytes;
        std::string checksum;
        append(checksum, checksumOf(std::string_view(file).substr(at, hashed - at), headOf(file), at));
        file.replace(hashed, checksumBytes, checksum);
        at = *end;
    }
}

}  // namespace spherule::recording
