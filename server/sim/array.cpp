#include "sim/array.h"

#include <algorithm>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr unsigned sorted = 1;
constexpr unsigned cleared = 2;
constexpr unsigned byId = 4;
constexpr unsigned scratch = 8;

std::string wordsOf(std::string_view type) {
    if (type == "vec4") return "rrrr";
    if (type == "float") return "r";
    if (type == "uvec4") return "uuuu";
    if (type == "uvec2") return "uu";
    if (type == "uint") return "u";
    return layout::wordsOf(type);
}

ArrayType row(std::string name, std::string_view type, Extent extent, unsigned flags) {
    // Kernels write names with a small first letter.
    name[0] = static_cast<char>(name[0] - 'A' + 'a');
    std::string words = wordsOf(type);
    const std::size_t bytes = 4 * words.size();
    return {.name = std::move(name),
            .type = type,
            .elementBytes = bytes,
            .words = std::move(words),
            .extent = extent,
            .sorted = (flags & sorted) != 0,
            .cleared = (flags & cleared) != 0,
            .byId = (flags & byId) != 0,
            .scratch = (flags & scratch) != 0};
}

const std::array<ArrayType, arrayCount>& rows() {
    static const std::array<ArrayType, arrayCount> all = {{
#define ARRAY(Name, type, extent, flags) row(#Name, #type, Extent::extent, flags),
#include "sim/arrays.def"
#undef ARRAY
    }};
    return all;
}

}  // namespace

const ArrayType& typeOf(Array array) {
    return rows().at(static_cast<std::size_t>(array));
}

std::string_view nameOf(Array array) {
    return typeOf(array).name;
}

std::optional<Array> arrayNamed(std::string_view name) {
    const auto found = std::ranges::find(rows(), name, &ArrayType::name);
    if (found == rows().end()) return std::nullopt;
    return static_cast<Array>(found - rows().begin());
}

}  // namespace spherule::sim
