// A file as a recording, opened and played from end to end, by seeking, and behind what is damaged. Bit 0 of the first
// byte makes checksums and the beginning right, as a hostile writer would: nothing behind them was ever reached
// otherwise. Bit 1 makes the place of the index right. The others say where to seek.
#include <google/protobuf/stubs/logging.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "store/bytes.h"
#include "store/record.h"
#include "store/recording.h"

namespace {

using namespace spherule;

void overwrite(std::string& content, std::size_t at, const std::string& with) {
    content.replace(at, with.size(), with);
}

// Records are walked by the lengths that they say; one that would go beyond the end is let be.
void makeSound(std::string& content, bool index) {
    if (content.size() < store::fileHeadBytes) return;
    overwrite(content, 0, store::fileHead());
    std::size_t at = store::fileHeadBytes;
    while (content.size() - at >= store::recordHeadBytes + store::checksumBytes) {
        const auto length = store::numberAt<std::uint32_t>(content, at);
        if (length > content.size() - at - store::recordHeadBytes - store::checksumBytes) break;
        const std::size_t hashed = store::recordHeadBytes + length;
        std::string sum;
        store::append(sum, std::uint64_t{XXH3_64bits(content.data() + at, hashed)});
        overwrite(content, at + hashed, sum);
        const bool last =
            store::numberAt<std::uint32_t>(content, at + 4) == static_cast<std::uint32_t>(store::Kind::Index);
        if (index && last && content.size() - at >= hashed + store::checksumBytes + store::trailerBytes) {
            std::string trailer;
            store::append(trailer, std::uint64_t{at});
            trailer.append(store::endMagic.begin(), store::endMagic.end());
            content.resize(at + hashed + store::checksumBytes);
            content += trailer;
            return;
        }
        at += hashed + store::checksumBytes;
    }
}

void require(bool holds) {
    if (!holds) std::abort();
}

void look(store::Recording& recording) {
    const store::Moment now = recording.now();
    require(now.positions.size() == recording.cells().size() && now.radii.size() == now.positions.size());
    require(recording.order().size() == now.positions.size() && std::isfinite(now.time) && now.error > 0);
    (void)recording.nextTime();
    (void)recording.takePassed();
}

// Forward to the end, or to what cannot be played.
void play(store::Recording& recording) {
    constexpr int most = 300;  // frames
    for (int k = 0; k < most; ++k) {
        const auto more = recording.next();
        if (!more && !recording.recover(recording.time())) return;
        if (more && !*more) return;
        look(recording);
    }
}

void playFile(const std::string& path, unsigned where) {
    auto recording = store::Recording::open(path);
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
    static const auto quiet = google::protobuf::SetLogHandler(nullptr);  // of names that are no UTF-8
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
