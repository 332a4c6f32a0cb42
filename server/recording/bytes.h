#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace spherule::recording {

static_assert(std::endian::native == std::endian::little, "files are little endian");

// Appends the bytes of a number, little endian.
template <class T>
void append(std::string& bytes, T number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Returns the number at `offset`, which must lie within `bytes`.
template <class T>
T numberAt(std::string_view bytes, std::size_t offset) {
    T number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

}  // namespace spherule::recording
