#include "store/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace spherule::store {

namespace {

constexpr std::size_t bufferBytes = 1U << 20U;

const char* adviceFor(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "make room there or write to another disk";
        case EFBIG:
            return "raise the limit (ulimit -f) or write less";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a place that you may write to";
        case ENOENT:
        case ENOTDIR:
            return "make its folder first";
        default:
            return "choose another place";
    }
}

}  // namespace

Result<OutputFile> OutputFile::create(const std::string& path, bool replace) {
    const int mode = O_WRONLY | O_CREAT | O_CLOEXEC | (replace ? O_TRUNC : O_EXCL);
    const int descriptor = open(path.c_str(), mode, 0666);
    if (descriptor >= 0) return OutputFile(path, descriptor);
    if (errno == EEXIST)
        return fail(ErrorKind::Input, path, "is there already; give --force to replace it, or another name");
    return fail(ErrorKind::Input, path,
                fmt::format("cannot be written: {}; {}", std::strerror(errno), adviceFor(errno)));
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)),
      size_(other.size_),
      written_(other.written_) {}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> OutputFile::write(std::string_view bytes) {
    size_ += bytes.size();
    if (buffer_.size() + bytes.size() < bufferBytes) {
        buffer_ += bytes;
        return {};
    }
    if (auto done = flush(); !done) return done;
    return put(bytes);
}

Result<void> OutputFile::flush() {
    auto done = put(buffer_);
    buffer_.clear();
    return done;
}

Result<void> OutputFile::close() {
    if (auto done = flush(); !done) return done;
    // What is no file, such as a pipe, knows no disk.
    if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) return cannot(errno);
    if (::close(std::exchange(descriptor_, -1)) != 0) return cannot(errno);
    return {};
}

Result<void> OutputFile::put(std::string_view bytes) {
    if (failed_) return tl::unexpected(*failed_);
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return cannot(errno);
        written_ += static_cast<std::uint64_t>(count);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return {};
}

tl::unexpected<Error> OutputFile::cannot(int error) {
    failed_ = Error{ErrorKind::Refused, path_,
                    fmt::format("cannot be written on after {} bytes: {}; {}; what has been written stays as it is",
                                written_, std::strerror(error), adviceFor(error))};
    return tl::unexpected(*failed_);
}

}  // namespace spherule::store
