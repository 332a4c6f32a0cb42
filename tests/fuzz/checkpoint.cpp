// Fuzzes the readers of checkpoints, of command logs, also in recordings, and of the scene in a saved state. The first
// byte chooses the reader. Bit 2 corrects the head and the checksums of a file, because a fuzzer does not get past
// them.
#include <google/protobuf/stubs/logging.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "checkpoint/log_reader.h"
#include "checkpoint/record_chain.h"
#include "checkpoint/saved_world.h"
#include "core/archive.h"
#include "recording/bytes.h"
#include "recording/record.h"
#include "scene/archive.h"

namespace {

using namespace spherule;

void require(bool holds) {
    if (!holds) std::abort();
}

// Returns the records of `content` in a file without flaws: each has a kind, a length and so many bytes.
std::string soundFile(std::string_view content, checkpoint::FileKind kind) {
    std::string file = checkpoint::headOf(kind);
    checkpoint::Position position = checkpoint::positionAfter(file);
    constexpr std::size_t headBytes = 3;
    while (content.size() >= headBytes) {
        const auto of = static_cast<checkpoint::Kind>(static_cast<unsigned char>(content[0]) % 5);
        const auto length = recording::numberAt<std::uint16_t>(content, 1);
        content.remove_prefix(headBytes);
        file += checkpoint::recordBytes(of, content.substr(0, length), position);
        content.remove_prefix(std::min<std::size_t>(length, content.size()));
    }
    return file;
}

// Returns a recording that carries the log. Pieces of `bytes` bytes come between other records.
std::string recordingWith(std::string_view log, std::size_t bytes) {
    const recording::FileHead head{.id = 5};
    std::string file = head.bytes();
    while (!log.empty()) {
        file += recording::recordBytes(recording::Kind::Log, 0, log.substr(0, bytes), head, file.size());
        file += recording::recordBytes(recording::Kind::Other, 0, "", head, file.size());
        log.remove_prefix(std::min(bytes, log.size()));
    }
    return file;
}

void readLog(const std::string& path) {
    auto log = checkpoint::LogReader::open(path);
    if (!log || !log->world()) return;
    for (;;) {
        const auto entry = log->next();
        if (!entry || !*entry) return;
        if ((*entry)->has_world() && !log->digestWorld()) return;
    }
}

// A scene that is read can be saved, and is the same when it is read again.
void readScene(std::string_view bytes) {
    Loader loader(bytes);
    scene::Scene scene;
    loader(scene);
    if (!loader.ok() || !scene::isWhole(scene)) return;
    Saver saver;
    saver(scene);
    Loader again(saver.bytes());
    scene::Scene same;
    again(same);
    require(again.ok() && again.left() == 0);
    Saver second;
    second(same);
    require(second.bytes() == saver.bytes());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto quiet = google::protobuf::SetLogHandler(nullptr);  // silences warnings about invalid UTF-8
    (void)quiet;
    if (size == 0) return 0;
    static const int file = memfd_create("checkpoint", MFD_CLOEXEC);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
    const unsigned reader = data[0] & 3U;
    if (reader == 2) {
        readScene(bytes);
        return 0;
    }
    const auto kind = reader == 0 ? checkpoint::FileKind::Checkpoint : checkpoint::FileKind::CommandLog;
    std::string content = (data[0] & 4U) != 0 ? soundFile(bytes, kind) : std::string(bytes);
    // Without bit 2, the input may be a damaged recording itself.
    if (reader == 3 && (data[0] & 4U) != 0) content = recordingWith(content, 1U + (data[0] >> 3U) * 13U);
    require(file >= 0 && ftruncate(file, 0) == 0);
    require(pwrite(file, content.data(), content.size(), 0) == static_cast<ssize_t>(content.size()));
    if (kind == checkpoint::FileKind::Checkpoint)
        (void)checkpoint::readCheckpoint(path);
    else
        readLog(path);
    return 0;
}
