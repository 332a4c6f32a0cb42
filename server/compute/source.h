#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compute/device.h"
#include "core/result.h"

namespace spherule::compute {

// A kernel as one text for the GLSL compiler. A directive `#line 100000 I + N I` means that line N of file I follows. I
// is an index into `files`; file 0 is the generated prologue: version and defines. The line number contains the file
// too, because Mesa's compiler forgets the file in messages about whole expressions.
struct ExpandedSource {
    struct Buffer {
        std::string type;
        std::string name;
    };

    std::string text;
    std::vector<std::string> files;
    std::vector<Buffer> buffers;  // declared by the kernel; the index is the binding
    bool countsGroups = false;    // a launch counts work groups: the kernel is a BUNDLE_KERNEL or a PAIR_KERNEL
};

// Replaces every line `#include "name"` of `file` by that file of `sources`, recursively and at each occurrence (shared
// files have no guards). Leaves `#include <name>` unchanged, because it is in a branch for C++. Replaces
// `BUFFER(access, type, name)` at the start of a line by a storage block at the next free binding. Errors name file and
// line. Causes are a missing file, a file that includes itself, a malformed declaration, two buffers of one name, and
// more than maxKernelBuffers buffers.
Result<ExpandedSource> expandSource(const SourceSet& sources, std::string_view file, std::span<const Define> defines);

// Returns the compiler's messages with file names and lines of `files` in place of numbers: "0:100012(5): error" of
// Mesa, "1(100012) : error" of NVIDIA and "ERROR: 1:100012:" of AMD become "integrate.comp:12".
std::string nameFiles(std::string_view compilerLog, std::span<const std::string> files);

}  // namespace spherule::compute
