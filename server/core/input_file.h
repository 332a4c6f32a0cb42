#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/result.h"

namespace spherule {

// A regular file that is read. What else a path may name (a folder, a pipe, a device) is refused without waiting for
// it. Used by one thread. Errors are Input and carry the path.
class InputFile {
  public:
    static Result<InputFile> open(const std::string& path);

    InputFile(InputFile&& other) noexcept;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    InputFile& operator=(InputFile&&) = delete;
    ~InputFile();

    // Bytes from `offset` on: `count` of them, or fewer at the end of the file.
    [[nodiscard]] Result<std::size_t> read(std::uint64_t offset, char* bytes, std::size_t count) const;

    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes, when it was opened
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    InputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

    std::string path_;
    int descriptor_;
    std::uint64_t size_ = 0;
};

// The whole file. One of more than `mostBytes` is refused by its size, before it is read.
Result<std::string> readFile(const std::string& path, std::uint64_t mostBytes);

// Reads a text file line by line, in memory for one block and one line.
class LineReader {
  public:
    explicit LineReader(InputFile file) : file_(std::move(file)) {}

    // To the next line; false at the end of the file. Refuses a line of more than `mostBytes`.
    Result<bool> next(std::size_t mostBytes);
    // Without its end, which is \n or \r\n, and without a byte-order mark in the first line.
    [[nodiscard]] const std::string& line() const { return line_; }
    [[nodiscard]] std::size_t number() const {
        return number_;
    }  // of the line, from 1; of the one that was refused, too

  private:
    Result<bool> fill();

    InputFile file_;
    std::string block_;
    std::size_t place_ = 0;  // in the block
    std::uint64_t offset_ = 0;
    std::string line_;
    std::size_t number_ = 0;
};

// Text without the byte-order mark of UTF-8, with which some editors begin it.
void dropByteOrderMark(std::string& text);

}  // namespace spherule
