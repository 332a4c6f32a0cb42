#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>

// Sees which folders a test program writes to the disk. It replaces fsync(): include it in one source of a program.
namespace spherule::support {

inline std::set<std::string>& syncedFolders() {
    static std::set<std::string> folders;
    return folders;
}

}  // namespace spherule::support

extern "C" int fsync(int descriptor) {
    struct stat about {};
    if (fstat(descriptor, &about) == 0 && S_ISDIR(about.st_mode)) {
        std::error_code error;
        const auto link = "/proc/self/fd/" + std::to_string(descriptor);
        spherule::support::syncedFolders().insert(std::filesystem::read_symlink(link, error).string());
    }
    return static_cast<int>(syscall(SYS_fsync, descriptor));
}
