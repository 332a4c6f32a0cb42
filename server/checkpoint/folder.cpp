#include "checkpoint/folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/heartbeat.h"
#include "core/input_file.h"
#include "core/log.h"
#include "recording/output_file.h"

namespace spherule::checkpoint {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "checkpoint-";
constexpr std::string_view suffix = ".sphc";
constexpr const char* passedOver = ".bad";  // added to the names of checkpoints that were passed over
constexpr const char* lockName = "lock";
constexpr std::uint64_t mostNumber = 1'000'000'000'000;
constexpr std::size_t blockBytes = 1U << 20U;
constexpr int mostSetAside = 1000;
constexpr std::uint64_t spareBytes = 1U << 20U;  // that stay free for other files
constexpr double megabyte = 1e6;

std::string nameOf(std::uint64_t number) {
    return fmt::format("{}{:08}{}", prefix, number, suffix);
}

// Returns the number in the name of a checkpoint; nullopt for other names.
std::optional<std::uint64_t> numberIn(std::string_view name) {
    if (!name.starts_with(prefix)) return std::nullopt;
    std::uint64_t number = 0;
    std::from_chars(name.data() + prefix.size(), name.data() + name.size(), number);
    if (number >= mostNumber || nameOf(number) != name) return std::nullopt;
    return number;
}

// Returns the numbers of the checkpoints in a folder, ascending. `error`: why it cannot be read.
std::vector<std::uint64_t> numbersIn(const std::string& path, std::error_code& error) {
    std::vector<std::uint64_t> numbers;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
        if (const auto number = numberIn(entry->path().filename().string())) numbers.push_back(*number);
    std::ranges::sort(numbers);
    return numbers;
}

// Opens the lock file in the folder. Returns -1 and sets errno if it fails. One can still go on from a folder whose
// file system has become read-only.
int openLock(const std::string& folder) {
    const std::string path = folder + "/" + lockName;
    const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock >= 0 || errno != EROFS) return lock;
    const int readOnly = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (readOnly >= 0) spdlog::warn("{} can only be read: no checkpoint will be written there", folder);
    if (readOnly < 0) errno = EROFS;
    return readOnly;
}

// Refused if the file cannot be read to its end for another reason than its content.
Result<void> checkReadable(const std::string& path) {
    const heartbeat::Pause reading;
    const auto no = [&](int error) {
        return fail(ErrorKind::Refused, path,
                    fmt::format("cannot be read: {}; it may be good, and is left alone", std::strerror(error)));
    };
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (file < 0) return errno == ENOENT ? Result<void>() : no(errno);
    std::vector<char> block(blockBytes);
    ssize_t got = 0;
    do got = ::read(file, block.data(), block.size());
    while (got > 0 || (got < 0 && errno == EINTR));
    const int error = got < 0 ? errno : 0;
    ::close(file);
    return error == 0 || error == EISDIR || error == EAGAIN ? Result<void>() : no(error);
}

// Renames a checkpoint that is passed over, to a name that is free.
void setAside(const std::string& path) {
    int result = -1;
    for (int k = 1; k <= mostSetAside; ++k) {
        const std::string name = k == 1 ? path + passedOver : fmt::format("{}{}{}", path, passedOver, k);
        result = renameat2(AT_FDCWD, path.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE);
        // This file system does not support RENAME_NOREPLACE.
        if (result != 0 && (errno == EINVAL || errno == ENOSYS) && access(name.c_str(), F_OK) != 0)
            result = std::rename(path.c_str(), name.c_str());
        if (result == 0 || errno != EEXIST) break;
    }
    if (result != 0) spdlog::warn("{} cannot be renamed: {}", path, std::strerror(errno));
}

// Removes files that were not complete when a program was killed.
void removeParts(const std::string& path) {
    std::vector<fs::path> parts;
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const std::size_t part = name.rfind(".part");
        if (part != std::string::npos && numberIn(std::string_view(name).substr(0, part)))
            parts.push_back(entry->path());
    }
    for (const fs::path& one : parts) fs::remove(one, error);
}

// Makes a folder and those in which it is, with their names on the disk.
std::error_code makeFolder(const std::string& path) {
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path one = fs::absolute(path, error); !one.empty() && !fs::exists(one, error); one = one.parent_path())
        missing.push_back(one);
    fs::create_directories(path, error);
    for (const fs::path& made : missing)
        if (const int failure = error ? 0 : recording::syncNamesIn(made.parent_path().string()); failure != 0)
            error.assign(failure, std::generic_category());
    return error;
}

}  // namespace

Result<Folder> Folder::open(const std::string& path, unsigned keep) {
    std::error_code error = makeFolder(path);
    if (error)
        return fail(ErrorKind::Input, path,
                    fmt::format("cannot be the folder of checkpoints: {}; choose a folder that can be made and written",
                                error.message()));
    const int lock = openLock(path);
    if (lock < 0)
        return fail(
            ErrorKind::Input, path,
            fmt::format("cannot hold checkpoints: {}; choose a folder that you may write to", std::strerror(errno)));
    if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
        const int why = errno;
        ::close(lock);
        if (why == EWOULDBLOCK)
            return fail(ErrorKind::Input, path,
                        "is used by another program, which writes its checkpoints there; choose another folder");
        return fail(ErrorKind::Input, path,
                    fmt::format("cannot be locked: {}; choose a folder on another file system", std::strerror(why)));
    }
    Folder folder(path, std::max(keep, 1U), lock);
    const auto numbers = numbersIn(path, error);
    if (error)
        return fail(ErrorKind::Input, path,
                    fmt::format("cannot be read: {}; choose a folder that you may read", error.message()));
    removeParts(path);
    if (!numbers.empty()) {
        folder.last_ = numbers.back();
        const std::uintmax_t bytes = fs::file_size(folder.pathOf(folder.last_), error);
        if (!error) folder.bytes_ = bytes;
    }
    return folder;
}

Folder::Folder(Folder&& other) noexcept
    : path_(std::move(other.path_)),
      keep_(other.keep_),
      lock_(std::exchange(other.lock_, -1)),
      last_(other.last_),
      bytes_(other.bytes_) {}

Folder::~Folder() {
    if (lock_ >= 0) ::close(lock_);
}

std::vector<std::uint64_t> Folder::numbers() const {
    std::error_code ignored;  // open() has read it
    return numbersIn(path_, ignored);
}

std::string Folder::pathOf(std::uint64_t number) const {
    return path_ + "/" + nameOf(number);
}

Result<std::optional<std::string>> Folder::useNewest(const Use& use, const std::function<void(const Error&)>& skipped) {
    std::error_code error;
    std::vector<std::uint64_t> all = numbersIn(path_, error);
    if (error) return fail(ErrorKind::Refused, path_, fmt::format("cannot be read: {}", error.message()));
    for (; !all.empty(); all.pop_back()) {
        const std::string path = pathOf(all.back());
        const auto useFile = [&] {
            auto world = readCheckpoint(path);
            return world ? use(std::move(*world)) : Result<void>(tl::unexpected(world.error()));
        };
        auto used = useFile();
        if (!used && used.error().kind == ErrorKind::Input) {
            if (auto readable = checkReadable(path); !readable) return tl::unexpected(readable.error());
            used = useFile();  // reading may have failed for a moment only
        }
        if (used) return path;
        if (used.error().where.empty()) used.error().where = path;
        if (used.error().kind != ErrorKind::Input) return tl::unexpected(used.error());
        skipped(used.error());
        setAside(path);
    }
    return std::nullopt;
}

// Refused if the disk has too little room for a checkpoint of about the size of the last one, or of the state if that
// is smaller.
Result<void> Folder::checkRoom(std::uint64_t stateBytes) const {
    const std::uint64_t bytes = std::min(bytes_, stateBytes);
    std::error_code error;
    const auto room = fs::space(path_, error);
    if (error || room.capacity == 0 || room.available >= bytes + bytes / 8 + spareBytes) return {};
    if (bytes_ == 0) return {};  // how well the state can be compressed is not known yet
    return fail(ErrorKind::Refused, path_,
                fmt::format("the disk has room for {:.1f} MB, a checkpoint takes about {:.1f} MB; make room there",
                            static_cast<double>(room.available) / megabyte, static_cast<double>(bytes) / megabyte));
}

Result<Folder::Written> Folder::write(SavedWorld world) {
    // Another program may have made files here since open().
    std::error_code error;
    while (last_ < mostNumber && fs::exists(pathOf(last_ + 1), error)) ++last_;
    const std::string path = pathOf(last_ + 1);
    if (auto room = checkRoom(world.state.bytes()); !room) return tl::unexpected(room.error());
    auto file = recording::OutputFile::create(path, false, recording::OutputFile::Appears::WhenClosed);
    if (!file) return tl::unexpected(file.error());
    const std::string head = headOf(FileKind::Checkpoint);
    Position position = positionAfter(head);
    const WriteBytes bytes = [&](const std::string& more) { return file->write(more); };
    auto done = bytes(head);
    if (done) done = checkpoint::write(std::move(world), position, bytes);
    if (done) done = file->close();
    if (!done) return tl::unexpected(done.error());
    ++last_;
    bytes_ = position.bytes;
    removeOldest();
    return Written{path, position.bytes};
}

void Folder::removeOldest() {
    const std::vector<std::uint64_t> good = numbers();
    std::error_code error;
    for (std::size_t k = 0; k + keep_ < good.size(); ++k)
        if (!fs::remove(pathOf(good[k]), error))
            spdlog::warn("{} cannot be removed: {}", pathOf(good[k]), error.message());
}

bool isCheckpoint(const std::string& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) return true;
    const std::string head = headOf(FileKind::Checkpoint).substr(0, magicBytes);
    std::string begin(head.size(), '\0');
    const auto file = InputFile::open(path);
    return file && file->read(0, begin.data(), begin.size()).value_or(0) == begin.size() && begin == head;
}

Result<std::string> newestIn(const std::string& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return path;
    const auto numbers = numbersIn(path, error);
    if (error) return fail(ErrorKind::Input, path, fmt::format("cannot be read: {}", error.message()));
    if (numbers.empty())
        return fail(ErrorKind::Input, path, "is a folder, must be a regular file or a folder with checkpoints");
    return path + "/" + nameOf(numbers.back());
}

}  // namespace spherule::checkpoint
