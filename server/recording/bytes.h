#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace spherule::recording {

static_assert(std::endian::native == std::endian::little, "files are little endian");

// The bytes of a number, little endian, at the end of `bytes`.
template <class T>
void append(std::string& bytes, T number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// The number at `offset`, which must lie within.
template <class T>
T numberAt(std::string_view bytes, std::size_t offset) {
    T number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

}  // namespace spherule::recording
