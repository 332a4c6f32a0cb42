// Fuzzes the reader of quality tables (--quality-table).
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "diagnostics/table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    const auto table = diagnostics::parseTable(std::string(reinterpret_cast<const char*>(data), size), "fuzz.json");
    if (!table) return 0;
    for (const diagnostics::Rung& rung : table->rungs)
        for (const auto& [name, measured] : rung.curves)
            if (!std::isfinite(measured.error) || !std::isfinite(measured.cost)) std::abort();
    return 0;
}
