#include "core/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <spdlog/fmt/fmt.h>

namespace spherule {

namespace {

constexpr std::size_t blockBytes = 64U << 10U;

const char* kindOf(mode_t mode) {
    if (S_ISDIR(mode)) return "is a folder";
    if (S_ISFIFO(mode)) return "is a pipe";
    if (S_ISSOCK(mode)) return "is a socket";
    return "is a device";
}

tl::unexpected<Error> unreadable(const std::string& path, int error) {
    if (error == ENOENT) return fail(ErrorKind::Input, path, "there is no such file");
    return fail(ErrorKind::Input, path, std::string("cannot be read: ") + std::strerror(error));
}

}  // namespace

Result<InputFile> InputFile::open(const std::string& path) {
    // O_NONBLOCK: without it, opening a pipe waits for a writer.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0 && errno == ENXIO) return fail(ErrorKind::Input, path, "is a socket, must be a regular file");
    if (descriptor < 0) return unreadable(path, errno);
    InputFile file(path, descriptor);
    struct stat about {};
    if (fstat(descriptor, &about) != 0) return unreadable(path, errno);
    if (!S_ISREG(about.st_mode))
        return fail(ErrorKind::Input, path, fmt::format("{}, must be a regular file", kindOf(about.st_mode)));
    file.size_ = static_cast<std::uint64_t>(about.st_size);
    return file;
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

InputFile::~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<std::size_t> InputFile::read(std::uint64_t offset, char* bytes, std::size_t count) const {
    std::size_t done = 0;
    while (done < count) {
        const ssize_t got = pread(descriptor_, bytes + done, count - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return unreadable(path_, errno);
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

Result<std::string> readFile(const std::string& path, std::uint64_t mostBytes) {
    const auto file = InputFile::open(path);
    if (!file) return tl::unexpected(file.error());
    if (file->size() > mostBytes)
        return fail(ErrorKind::Input, path,
                    fmt::format("has {} bytes, at most {} are allowed", file->size(), mostBytes));
    std::string text;
    // A file may grow while it is read, and files of /proc report no size.
    while (text.size() <= mostBytes) {
        const std::size_t begin = text.size();
        const std::size_t wanted = std::max<std::size_t>(file->size() + 1, begin + blockBytes) - begin;
        text.resize(begin + wanted);
        const auto got = file->read(begin, text.data() + begin, wanted);
        if (!got) return tl::unexpected(got.error());
        text.resize(begin + *got);
        if (*got < wanted) break;
    }
    if (text.size() <= mostBytes) return text;
    return fail(ErrorKind::Input, path, fmt::format("is longer than the {} bytes that are allowed", mostBytes));
}

Result<bool> LineReader::fill() {
    block_.resize(blockBytes);
    place_ = 0;
    const auto got = file_.read(offset_, block_.data(), block_.size());
    block_.resize(got.value_or(0));
    if (!got) return tl::unexpected(got.error());
    offset_ += *got;
    return *got > 0;
}

Result<bool> LineReader::next(std::size_t mostBytes) {
    line_.clear();
    ++number_;
    for (bool begun = false;; begun = true) {
        if (place_ == block_.size()) {
            const auto more = fill();
            if (!more) return more;
            if (!*more && !begun) return false;
            if (!*more) break;
        }
        const std::size_t end = std::min(block_.find('\n', place_), block_.size());
        line_.append(block_, place_, end - place_);
        place_ = std::min(end + 1, block_.size());
        if (line_.size() > mostBytes)
            return fail(ErrorKind::Input, file_.path(), fmt::format("the line is longer than {} bytes", mostBytes));
        if (end < block_.size()) break;
    }
    if (line_.ends_with('\r')) line_.pop_back();
    if (number_ == 1) dropByteOrderMark(line_);
    return true;
}

void dropByteOrderMark(std::string& text) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    if (text.starts_with(mark)) text.erase(0, mark.size());
}

}  // namespace spherule
