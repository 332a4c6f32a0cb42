#include "recording/writer.h"

#include "recording/bytes.h"

namespace spherule::recording {

namespace {

using namespace std::chrono_literals;
constexpr auto flushEvery = 1s;

}  // namespace

Result<Writer> Writer::create(const std::string& path, bool replace, std::uint32_t id) {
    auto file = OutputFile::create(path, replace);
    if (!file) return tl::unexpected(file.error());
    Writer writer(std::move(*file), id);
    if (auto done = writer.file_.write(writer.head_.bytes()); !done) return tl::unexpected(done.error());
    if (auto done = writer.file_.flush(); !done) return tl::unexpected(done.error());
    return writer;
}

Result<void> Writer::add(Kind kind, double time, std::string_view message) {
    if (time < time_ && file_.size() > fileHeadBytes)
        return fail(ErrorKind::Refused, file_.path(), "cannot record a time before the last one");
    if (message.size() > mostPayload)
        return fail(ErrorKind::Refused, file_.path(), "cannot hold a frame of more than 1 GiB: record fewer spheres");
    const bool plays = index_.frames > 0;
    const std::uint64_t at = file_.size();
    index_.add(kind, time, at);
    time_ = time;
    if (auto done = file_.write(recordBytes(kind, time, message, head_, at)); !done) return done;
    const auto now = std::chrono::steady_clock::now();
    const bool firstFrame = !plays && index_.frames > 0;
    if (!firstFrame && now - flushed_ < flushEvery) return {};
    flushed_ = now;
    auto done = file_.flush();
    if (done && firstFrame) file_.persist();
    return done;
}

std::uint64_t Writer::bytesWith(std::size_t payload) const {
    const std::uint64_t index = indexHeadBytes + entryBytes * (index_.entries.size() + 1);
    return file_.size() + 2 * (recordHeadBytes + checksumBytes) + payload + index + trailerBytes;
}

Result<void> Writer::finish() {
    if (index_.frames == 0) return {};
    const std::uint64_t at = file_.size();
    std::string end = recordBytes(Kind::Index, time_, index_.payload(), head_, at);
    append(end, at);
    end.append(endMagic.begin(), endMagic.end());
    if (auto done = file_.write(end); !done) return done;
    return file_.close();
}

}  // namespace spherule::recording
