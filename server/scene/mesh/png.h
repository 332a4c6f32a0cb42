#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace spherule::scene {

// The grey values of an image, row by row from the top.
struct GreyImage {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<double> values{};  // 0: black, 1: white
};

// Reads a grey PNG of 8 or 16 bits without conversions of colour. Refuses more than `mostPixels`. The error has no
// place.
Result<GreyImage> readPng(std::string_view bytes, std::size_t mostPixels);

}  // namespace spherule::scene
