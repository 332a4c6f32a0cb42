#include "recording/carried_log.h"

#include <algorithm>
#include <utility>

#include "core/input_file.h"

namespace spherule::recording {

bool isRecording(const std::string& path) {
    const auto file = InputFile::open(path);
    std::string begin(fileMagic.size(), '\0');
    if (!file) return false;
    const auto got = file->read(0, begin.data(), begin.size());
    return got && *got == begin.size() && std::ranges::equal(begin, fileMagic, [](char letter, unsigned char wanted) {
               return static_cast<unsigned char>(letter) == wanted;
           });
}

Result<CarriedLog> CarriedLog::open(const std::string& path) {
    auto file = RecordFile::open(path);
    if (!file) return tl::unexpected(file.error());
    CarriedLog log(std::move(*file));
    for (std::uint64_t offset = fileHeadBytes; offset < log.file_.size();) {
        const auto head = log.file_.readHead(offset);
        if (!head) log.flaw_ = head.error();
        if (!head || head->kind == Kind::Index) break;
        const std::uint64_t payload = head->end - offset - recordHeadBytes - checksumBytes;
        if (head->kind == Kind::Log && payload > 0) {
            log.pieces_.push_back({.begin = log.size_, .offset = offset});
            log.size_ += payload;
        }
        offset = head->end;
    }
    if (log.pieces_.empty() && log.flaw_) return tl::unexpected(*log.flaw_);
    if (log.pieces_.empty())
        return fail(ErrorKind::Input, path, "carries no command log: it was recorded without --record-log");
    return log;
}

Result<std::size_t> CarriedLog::read(std::uint64_t offset, char* bytes, std::size_t count) {
    std::size_t done = 0;
    while (done < count && offset + done < size_) {
        const std::uint64_t at = offset + done;
        const auto after = std::ranges::upper_bound(pieces_, at, {}, &Piece::begin);
        const auto number = static_cast<std::size_t>(after - pieces_.begin());
        const Piece& piece = pieces_[number - 1];
        if (held_ != number) {
            auto record = file_.read(piece.offset);
            if (!record) return tl::unexpected(record.error());
            payload_ = std::move(record->payload);
            held_ = number;
        }
        const std::size_t from = at - piece.begin;
        const std::size_t part = std::min(count - done, payload_.size() - from);
        payload_.copy(bytes + done, part, from);
        done += part;
    }
    return done;
}

}  // namespace spherule::recording
