// Fuzzes the reader of extended XYZ files with spheres. Bits 1 and 2 of the first byte: the frame.
#include "group_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    fuzz::buildFromFile(data, size, [](v1::Group& group, const std::string& file, std::uint8_t first) {
        group.mutable_xyz()->set_file(file);
        group.mutable_xyz()->set_frame(first >> 1U & 3U);
    });
    return 0;
}
