#include "checkpoint/log_reader.h"

#include <xxhash.h>

#include <utility>

#include "core/heartbeat.h"
#include "core/memory.h"

namespace spherule::checkpoint {

namespace {

// A parsed message takes up to 50 bytes for each of its bytes. Entries that are not large take little memory anyway.
constexpr std::size_t large = 1U << 20U;
constexpr std::size_t perByte = 50;

}  // namespace

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
    const std::size_t bytes = (*record)->payload.size();
    auto claim = memory::Claim::make(records_.path(), "an entry of a command log", bytes > large ? perByte * bytes : 0);
    if (!claim) return tl::unexpected(claim.error());
    v1::LogEntry entry;
    if ((*record)->kind != Kind::Entry || !entry.ParseFromString((*record)->payload) ||
        entry.kind_case() == v1::LogEntry::KIND_NOT_SET)
        return records_.bad("before it is no entry of a command log");
    return entry;
}

}  // namespace spherule::checkpoint
