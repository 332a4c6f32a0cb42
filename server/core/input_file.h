#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/result.h"

namespace spherule {

// A regular file for reading. open() refuses folders, pipes and devices without blocking. Used by one thread. Errors:
// Input, with the path.
class InputFile {
  public:
    static Result<InputFile> open(const std::string& path);

    InputFile(InputFile&& other) noexcept;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    InputFile& operator=(InputFile&&) = delete;
    ~InputFile();

    // Reads `count` bytes from `offset` on and returns their number; fewer at the end of the file.
    [[nodiscard]] Result<std::size_t> read(std::uint64_t offset, char* bytes, std::size_t count) const;

    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes, at the time of open()
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    InputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

    std::string path_;
    int descriptor_;
    std::uint64_t size_ = 0;
};

// Reads the whole file. Input if it has more than `mostBytes`; checked before it is read.
Result<std::string> readFile(const std::string& path, std::uint64_t mostBytes);

// Reads a text file line by line. Allocates memory for one block and one line.
class LineReader {
  public:
    explicit LineReader(InputFile file) : file_(std::move(file)) {}

    // Moves to the next line; returns false at the end of the file. Input if the line has more than `mostBytes`.
    Result<bool> next(std::size_t mostBytes);
    // The line without \n or \r\n, and without a byte-order mark in the first line.
    [[nodiscard]] const std::string& line() const { return line_; }
    [[nodiscard]] std::size_t number() const { return number_; }       // of the line, from 1; also of a refused line
    [[nodiscard]] std::uint64_t bytesRead() const { return offset_; }  // blocks in advance count
    [[nodiscard]] std::uint64_t size() const { return file_.size(); }  // bytes

  private:
    Result<bool> fill();

    InputFile file_;
    std::string block_;
    std::size_t place_ = 0;  // offset in the block
    std::uint64_t offset_ = 0;
    std::string line_;
    std::size_t number_ = 0;
};

// Removes a byte-order mark of UTF-8 from the beginning of the text.
void dropByteOrderMark(std::string& text);

}  // namespace spherule
