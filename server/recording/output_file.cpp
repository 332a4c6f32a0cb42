#include "recording/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace spherule::recording {

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

// Creates the first free of path.part, path.part2, ... Returns -1 and sets errno if it fails.
int openBeside(const std::string& path, std::string& place) {
    constexpr int mostNames = 100;
    int descriptor = -1;
    for (int k = 1; k <= mostNames; ++k) {
        place = k == 1 ? path + ".part" : fmt::format("{}.part{}", path, k);
        descriptor = open(place.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST) break;
    }
    return descriptor;
}

tl::unexpected<Error> isThere(const std::string& path) {
    return fail(ErrorKind::Input, path, "is there already; give --force to replace it, or another name");
}

tl::unexpected<Error> cannotOpen(const std::string& path, int error) {
    return fail(ErrorKind::Input, path,
                fmt::format("cannot be written: {}; {}", std::strerror(error), adviceFor(error)));
}

}  // namespace

int syncNamesIn(const std::string& folder) {
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return 0;  // it may be written to, but not be read
    const int error = fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    return error == EINVAL || error == EROFS ? 0 : error;
}

Result<OutputFile> OutputFile::create(const std::string& path, bool replace, Appears appears) {
    struct stat about {};
    const bool exists = lstat(path.c_str(), &about) == 0;
    if (exists && !replace) return isThere(path);
    const bool reached = exists && stat(path.c_str(), &about) == 0;  // a link may be dangling
    if (appears == Appears::WhenClosed && (!exists || (reached && S_ISREG(about.st_mode)))) {
        std::error_code error;
        // The target of a link is replaced, not the link.
        const std::string target = exists ? std::filesystem::canonical(path, error).string() : path;
        std::string place;
        const int descriptor = openBeside(target, place);
        if (descriptor < 0) return cannotOpen(path, errno);
        OutputFile file(path, descriptor);
        file.place_ = std::move(place);
        file.target_ = target;
        file.replace_ = replace;
        return file;
    }
    // O_NONBLOCK: without it, opening a pipe waits for a reader.
    const int mode = O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (replace ? 0 : O_EXCL);
    const int descriptor = open(path.c_str(), mode, 0666);
    if (descriptor < 0 && errno == EEXIST) return isThere(path);
    if (descriptor < 0 && errno == ENXIO)
        return fail(ErrorKind::Input, path, "cannot be written: it is a pipe or a socket that nobody reads");
    if (descriptor < 0) return cannotOpen(path, errno);
    OutputFile file(path, descriptor);
    if (fstat(descriptor, &about) != 0 || fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK) != 0)
        return cannotOpen(path, errno);
    if (S_ISREG(about.st_mode)) file.place_ = path;
    file.stale_ = exists;
    file.unnamed_ = !exists && !file.place_.empty();
    return file;
}

Result<OutputFile> OutputFile::standardOutput() {
    const int descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (descriptor < 0) return cannotOpen("standard output", errno);
    return OutputFile("standard output", descriptor);
}

Result<OutputFile> OutputFile::goOn(const std::string& path, std::uint64_t bytes) {
    const int descriptor = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) return cannotOpen(path, errno);
    OutputFile file(path, descriptor);
    file.persistent_ = true;
    struct stat about {};
    if (fstat(descriptor, &about) != 0) return cannotOpen(path, errno);
    if (!S_ISREG(about.st_mode) || static_cast<std::uint64_t>(about.st_size) < bytes)
        return fail(ErrorKind::Input, path, fmt::format("is no file of at least {} bytes any more", bytes));
    const auto end = static_cast<off_t>(bytes);
    if (ftruncate(descriptor, end) != 0 || lseek(descriptor, end, SEEK_SET) != end) return cannotOpen(path, errno);
    file.place_ = path;
    file.size_ = file.written_ = bytes;
    return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      place_(std::move(other.place_)),
      target_(std::move(other.target_)),
      replace_(other.replace_),
      stale_(other.stale_),
      unnamed_(other.unnamed_),
      persistent_(other.persistent_),
      buffer_(std::move(other.buffer_)),
      size_(other.size_),
      written_(other.written_),
      failed_(std::move(other.failed_)) {}

OutputFile::~OutputFile() {
    if (descriptor_ < 0) return;
    struct stat own {};
    struct stat named {};
    const bool removes = !place_.empty() && !persistent_ && !stale_ && fstat(descriptor_, &own) == 0 &&
                         stat(place_.c_str(), &named) == 0 && own.st_dev == named.st_dev && own.st_ino == named.st_ino;
    if (removes) unlink(place_.c_str());
    ::close(descriptor_);
}

Result<void> OutputFile::stillThere() {
    if (failed_) return tl::unexpected(*failed_);
    struct stat about {};
    if (place_.empty() || fstat(descriptor_, &about) != 0 || about.st_nlink > 0) return {};
    failed_ =
        Error{ErrorKind::Refused, path_, "was deleted while it was written, or its folder was; nothing of it is kept"};
    return tl::unexpected(*failed_);
}

Result<void> OutputFile::write(std::string_view bytes) {
    size_ += bytes.size();
    if (buffer_.size() + bytes.size() < bufferBytes) {
        buffer_ += bytes;
        return {};
    }
    if (auto done = flush(); !done) return done;
    return writeBytes(bytes);
}

Result<void> OutputFile::flush() {
    auto done = writeBytes(buffer_);
    buffer_.clear();
    return done ? stillThere() : done;
}

Result<void> OutputFile::sync() {
    if (auto done = flush(); !done) return done;
    // Pipes and some file systems do not support fsync.
    if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) return cannot(errno);
    return std::exchange(unnamed_, false) ? syncName(place_) : Result<void>();
}

Result<void> OutputFile::close() {
    if (auto done = sync(); !done) return done;
    if (auto done = publish(); !done) return done;
    persistent_ = true;
    if (::close(std::exchange(descriptor_, -1)) != 0) return cannot(errno);
    return {};
}

// Moves the temporary file to the target.
Result<void> OutputFile::publish() {
    if (target_.empty()) return {};
    if (!replace_) {
        if (renameat2(AT_FDCWD, place_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0)
            return syncName(target_);
        if (errno == EEXIST) return isThere(path_);
        if (errno != EINVAL && errno != ENOSYS) return cannot(errno);
        // This file system does not support RENAME_NOREPLACE.
        if (access(target_.c_str(), F_OK) == 0) return isThere(path_);
    }
    if (std::rename(place_.c_str(), target_.c_str()) != 0) return cannot(errno);
    return syncName(target_);
}

Result<void> OutputFile::syncName(const std::string& path) {
    const int error = syncNamesIn(std::filesystem::absolute(path).parent_path().string());
    if (error != 0) return cannot(error);
    return {};
}

Result<void> OutputFile::writeBytes(std::string_view bytes) {
    if (failed_) return tl::unexpected(*failed_);
    if (stale_ && !place_.empty() && ftruncate(descriptor_, 0) != 0) return cannot(errno);
    stale_ = false;
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
    failed_ = Error{
        ErrorKind::Refused, path_,
        fmt::format("writing failed after {} bytes: {}; {}; {}", written_, std::strerror(error), adviceFor(error),
                    persistent_ || place_.empty() ? "what has been written stays as it is" : "nothing of it is kept")};
    return tl::unexpected(*failed_);
}

}  // namespace spherule::recording
