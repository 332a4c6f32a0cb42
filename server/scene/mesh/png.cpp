#include "scene/mesh/png.h"

#include <csetjmp>
#include <cstring>

#include <png.h>
#include <spdlog/fmt/fmt.h>

namespace spherule::scene {

namespace {

constexpr std::uint32_t longestSide = 1U << 20U;  // pixels
constexpr std::size_t mostChunkBytes = 8U << 20U;

struct Reading {
    const char* bytes = nullptr;
    std::size_t left = 0;
    char message[128] = "";
    png_structp png = nullptr;
    png_infop info = nullptr;
    png_uint_32 columns = 0;
    png_uint_32 rows = 0;
    int depth = 0;
    int colour = 0;
};

void onError(png_structp png, png_const_charp message) {
    auto* const reading = static_cast<Reading*>(png_get_error_ptr(png));
    std::strncpy(reading->message, message, sizeof reading->message - 1);
    png_longjmp(png, 1);
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void onRead(png_structp png, png_bytep to, std::size_t count) {
    auto* const reading = static_cast<Reading*>(png_get_io_ptr(png));
    if (count > reading->left) png_error(png, "the file ends too early");
    std::memcpy(to, reading->bytes, count);
    reading->bytes += count;
    reading->left -= count;
}

// libpng jumps out of these functions: they have no objects that need destructors. They return false on an error.
bool readHead(Reading& reading) {
    if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
    png_set_read_fn(reading.png, &reading, onRead);
    png_set_user_limits(reading.png, longestSide, longestSide);
    png_set_chunk_malloc_max(reading.png, mostChunkBytes);
    png_read_info(reading.png, reading.info);
    png_get_IHDR(reading.png, reading.info, &reading.columns, &reading.rows, &reading.depth, &reading.colour, nullptr,
                 nullptr, nullptr);
    return true;
}

bool readRows(Reading& reading, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
    png_set_interlace_handling(reading.png);
    png_read_update_info(reading.png, reading.info);
    png_read_image(reading.png, rows);
    return true;
}

tl::unexpected<Error> refused(const std::string& reason) {
    return fail(ErrorKind::Input, "", reason);
}

Result<GreyImage> read(Reading& reading, std::size_t mostPixels) {
    const auto broken = [&] { return refused(fmt::format("cannot be read as PNG: {}", reading.message)); };
    if (!readHead(reading)) return broken();
    if (reading.colour != PNG_COLOR_TYPE_GRAY || (reading.depth != 8 && reading.depth != 16))
        return refused(fmt::format("is no grey PNG of 8 or 16 bits; it has {} bits{}", reading.depth,
                                   reading.colour == PNG_COLOR_TYPE_GRAY ? "" : ", and colours or transparency"));
    const std::size_t pixels = std::size_t{reading.columns} * reading.rows;
    if (pixels > mostPixels)
        return refused(fmt::format("has {} by {} pixels, {} in all, must have at most {}; make it smaller",
                                   reading.columns, reading.rows, pixels, mostPixels));
    const std::size_t bytesPerPixel = reading.depth == 16 ? 2 : 1;
    std::vector<png_byte> bytes(pixels * bytesPerPixel);
    std::vector<png_bytep> rows(reading.rows);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = &bytes[k * reading.columns * bytesPerPixel];
    if (!readRows(reading, rows.data())) return broken();
    GreyImage image{reading.columns, reading.rows, std::vector<double>(pixels)};
    for (std::size_t k = 0; k < pixels; ++k)
        image.values[k] = bytesPerPixel == 1 ? bytes[k] / 255.0 : (256 * bytes[2 * k] + bytes[2 * k + 1]) / 65535.0;
    return image;
}

}  // namespace

Result<GreyImage> readPng(std::string_view bytes, std::size_t mostPixels) {
    Reading reading{.bytes = bytes.data(), .left = bytes.size()};
    reading.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, onError, onWarning);
    if (reading.png != nullptr) reading.info = png_create_info_struct(reading.png);
    Result<GreyImage> image = refused("there is no memory to read it");
    if (reading.info != nullptr) image = read(reading, mostPixels);
    png_destroy_read_struct(&reading.png, &reading.info, nullptr);
    return image;
}

}  // namespace spherule::scene
