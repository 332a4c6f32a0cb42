// Fuzzes Recording: opens a file, plays it to the end, seeks, and continues after damaged records. Bit 0 of the first
// byte corrects checksums and the file head, because a fuzzer does not get past them. Bit 1 corrects the offset of the
// index. The other bits give the time to seek.
#include <google/protobuf/stubs/logging.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "record_bytes.h"
#include "recording/bytes.h"
#include "recording/record.h"
#include "recording/recording.h"

namespace {

using namespace spherule;

// Corrects the head of the file, and the checksums of its records. The file stays one of version 1, or becomes one of
// version 2. `index`: the trailer, too.
void makeSound(std::string& content, bool index) {
    if (content.size() < recording::fileHeadBytes) return;
    const bool old = content[recording::fileMagic.size()] == 1;
    const auto id = recording::numberAt<std::uint32_t>(content, recording::fileMagic.size() + 4);
    const recording::FileHead head =
        old ? recording::FileHead{.version = 1} : recording::FileHead{.version = 2, .id = id};
    content.replace(0, recording::fileHeadBytes, head.bytes());
    recording::setChecksums(content);
    if (!index) return;
    std::size_t at = recording::fileHeadBytes;
    while (const auto end = recording::endOfRecord(content, at)) {
        const bool last = recording::kindOf(std::string_view(content).substr(at)) == recording::Kind::Index;
        if (last && content.size() - *end >= recording::trailerBytes) {
            content.resize(*end);
            recording::append(content, std::uint64_t{at});
            content.append(recording::endMagic.begin(), recording::endMagic.end());
            return;
        }
        at = *end;
    }
}

void require(bool holds) {
    if (!holds) std::abort();
}

void look(recording::Recording& recording) {
    const recording::Snapshot now = recording.now();
    require(now.positions.size() == recording.cells(0).size() && now.spheres->radii.size() == now.positions.size());
    require(recording.order().size() == now.positions.size() && std::isfinite(now.time) && now.error > 0);
    (void)recording.nextTime();
    (void)recording.takeSkippedEvents();
}

// Plays to the end, or to the first error.
void play(recording::Recording& recording) {
    constexpr int most = 300;  // frames
    for (int k = 0; k < most; ++k) {
        const auto more = recording.next();
        if (!more && !recording.recover(recording.time())) return;
        if (more && !*more) return;
        look(recording);
    }
}

void playFile(const std::string& path, unsigned where) {
    auto recording = recording::Recording::open(path);
    if (!recording) return;
    require(recording->frames() > 0 && recording->begin() <= recording->end());
    play(*recording);
    const double length = recording->end() - recording->begin();
    for (const double share : {where / 64.0, 1.0, 0.0, 0.5, 2.0}) {
        if (!recording->seek(recording->begin() + share * length)) continue;
        look(*recording);
    }
    play(*recording);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto quiet = google::protobuf::SetLogHandler(nullptr);  // silences warnings about invalid UTF-8
    (void)quiet;
    if (size == 0) return 0;
    static const int file = memfd_create("recording", MFD_CLOEXEC);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    std::string content(reinterpret_cast<const char*>(data + 1), size - 1);
    if ((data[0] & 1U) != 0) makeSound(content, (data[0] & 2U) != 0);
    require(file >= 0 && ftruncate(file, 0) == 0);
    require(pwrite(file, content.data(), content.size(), 0) == static_cast<ssize_t>(content.size()));
    playFile(path, data[0] >> 2U);
    return 0;
}
