// Fuzzes the reader of CSV files with spheres.
#include "group_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    fuzz::buildFromFile(data, size, [](v1::Group& group, const std::string& file, std::uint8_t) {
        group.mutable_csv()->set_file(file);
    });
    return 0;
}
