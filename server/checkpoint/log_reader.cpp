#include "checkpoint/log_reader.h"

#include <xxhash.h>

#include <utility>

#include "core/heartbeat.h"

namespace spherule::checkpoint {

Result<LogReader> LogReader::open(const std::string& path) {
    auto records = RecordReader::open(path, FileKind::CommandLog);
    if (!records) return tl::unexpected(records.error());
    return LogReader(std::move(*records));
}

Result<std::uint64_t> LogReader::digestWorld() {
    const heartbeat::Pause reading;
    const auto head = readHead(records_);
    if (!head) return tl::unexpected(head.error());
    std::uint64_t digest = 0;
    for (;;) {
        const auto record = records_.next();
        if (!record) return tl::unexpected(record.error());
        if (!*record) return records_.bad("is missing: the file is cut off");
        if ((*record)->kind == Kind::End) return digest;
        if ((*record)->kind != Kind::Part) return records_.bad("before it is no part of a state");
        digest = XXH3_64bits_withSeed((*record)->payload.data(), (*record)->payload.size(), digest);
    }
}

Result<std::optional<v1::LogEntry>> LogReader::next() {
    const auto record = records_.next();
    if (!record) return tl::unexpected(record.error());
    if (!*record) return std::nullopt;
    v1::LogEntry entry;
    if ((*record)->kind != Kind::Entry || !entry.ParseFromString((*record)->payload) ||
        entry.kind_case() == v1::LogEntry::KIND_NOT_SET)
        return records_.bad("before it is no entry of a command log");
    return entry;
}

}  // namespace spherule::checkpoint
