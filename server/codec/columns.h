#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "codec/rendition.h"
#include "spherule/v1/frame.pb.h"

// The values of each sphere that frames carry. Each column is a chain of docs/codec.md with its own quantum.
namespace spherule::codec {

// The values of one column in a frame: quantum * q, with q in the bytes.
struct EncodedColumn {
    double quantum = 0;
    std::string_view spb;
};

struct Column {
    std::string_view name;  // of its array on the device, see sim/arrays.def
    bool places = false;    // values are places, which repeat along periodic axes
    // Returns the grid spacing of the values for a smallest radius (m).
    double (*quantumFor)(v1::Tier tier, double smallestRadius);
    EncodedColumn (*read)(const v1::Frame& frame);
    void (*write)(v1::Frame& frame, double quantum, std::string spb);
};

// The first column is the position (m), relative to the centre of the bounds.
inline constexpr std::array columns = {
    Column{.name = "position",
           .places = true,
           .quantumFor = quantumOf,
           .read =
               [](const v1::Frame& frame) {
                   return EncodedColumn{frame.quantum(), frame.spb()};
               },
           .write =
               [](v1::Frame& frame, double quantum, std::string spb) {
                   frame.set_quantum(quantum);
                   frame.set_spb(std::move(spb));
               }},
};
inline constexpr std::size_t columnCount = columns.size();
template <class T>
using PerColumn = std::array<T, columnCount>;

}  // namespace spherule::codec
