#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compute/device.h"
#include "core/result.h"

namespace spherule::compute {

// A kernel as one text for the GLSL compiler. Directives `#line 100000 I + N I` say that what follows is line N of file
// I (an index into `files`; 0 is the prologue that we write: version and defines). The line carries the file once more
// because Mesa's compiler forgets the file of whole expressions.
struct ExpandedSource {
    struct Buffer {
        std::string type;
        std::string name;
    };

    std::string text;
    std::vector<std::string> files;
    std::vector<Buffer> buffers;  // that it declares; the index is the binding
};

// Replaces every line `#include "name"` of `file` by that file of `sources`, recursively and each time it is named
// (shared files have no guards); `#include <name>` is left to the C++ branch it stands in. Replaces `BUFFER(access,
// type, name)` at the start of a line by a storage block at the next free binding. Errors name file and line: a file
// that is not there, a file that includes itself, a declaration that is not of this form, a second buffer of one name,
// more than maxKernelBuffers.
Result<ExpandedSource> expandSource(const SourceSet& sources, std::string_view file, std::span<const Define> defines);

// A compiler's messages with the file names and lines of `files` in place of numbers: "0:100012(5): error" of Mesa,
// "1(100012) : error" of NVIDIA and "ERROR: 1:100012:" of AMD become "integrate.comp:12".
std::string nameFiles(std::string_view compilerLog, std::span<const std::string> files);

}  // namespace spherule::compute
