#include "recording/index.h"

#include <cmath>
#include <limits>

#include "recording/bytes.h"

namespace spherule::recording {

void Index::add(Kind kind, double time, std::uint64_t offset) {
    if (isFrame(kind)) {
        if (frames++ == 0) begin = time;
        end = time;
    }
    if (isIndexed(kind)) entries.push_back({.offset = offset, .time = time, .kind = kind});
}

std::string Index::payload() const {
    std::string bytes;
    append(bytes, frames);
    append(bytes, begin);
    append(bytes, end);
    for (const Entry& entry : entries) {
        append(bytes, entry.offset);
        append(bytes, entry.time);
        append(bytes, static_cast<std::uint32_t>(entry.kind));
        append(bytes, std::uint32_t{0});
    }
    return bytes;
}

Result<Index> Index::from(std::string_view payload, std::uint64_t offset) {
    const auto bad = fail(ErrorKind::Input, "index", "is invalid");
    if (payload.size() < indexHeadBytes || (payload.size() - indexHeadBytes) % entryBytes != 0) return bad;
    Index index{.frames = numberAt<std::uint64_t>(payload, 0),
                .begin = numberAt<double>(payload, 8),
                .end = numberAt<double>(payload, 16),
                .entries = {}};
    if (!std::isfinite(index.begin) || !std::isfinite(index.end) || index.end < index.begin) return bad;
    Entry last{.offset = fileHeadBytes - 1, .time = -std::numeric_limits<double>::infinity()};
    for (std::size_t at = indexHeadBytes; at < payload.size(); at += entryBytes) {
        const Entry entry{.offset = numberAt<std::uint64_t>(payload, at),
                          .time = numberAt<double>(payload, at + 8),
                          .kind = static_cast<Kind>(numberAt<std::uint32_t>(payload, at + 16))};
        if (entry.offset <= last.offset || entry.offset >= offset || !(entry.time >= last.time) ||
            !std::isfinite(entry.time) || !isIndexed(entry.kind))
            return bad;
        index.entries.push_back(last = entry);
    }
    return index;
}

Contents contentsOf(const RecordFile& file) {
    Contents contents;
    if (const std::uint64_t at = file.indexOffset(); at >= fileHeadBytes) {
        const auto record = file.read(at);
        if (record && record->kind == Kind::Index && record->end + trailerBytes == file.size()) {
            if (auto index = Index::from(record->payload, at)) {
                contents.index = std::move(*index);
                contents.end = at;
                return contents;
            }
        }
    }
    contents.end = fileHeadBytes;
    contents.damage = "it was not finished";
    double time = -std::numeric_limits<double>::infinity();
    while (contents.end < file.size()) {
        const auto record = file.read(contents.end);
        if (!record || record->kind == Kind::Index || record->time < time) {
            contents.damage = record ? "its end is damaged" : record.error().message;
            break;
        }
        contents.index.add(record->kind, record->time, contents.end);
        contents.end = record->end;
        time = record->time;
    }
    return contents;
}

}  // namespace spherule::recording
