#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Sanitizes external text for messages, logs and terminals. Any thread.
namespace spherule {

// Returns valid UTF-8, which messages require: replaces each invalid byte by U+FFFD. File names may be any bytes.
std::string utf8(std::string_view text);

// Returns the first `most` bytes of UTF-8, or up to 3 fewer, so that no character is cut.
std::string_view cutUtf8(std::string_view text, std::size_t most);

// Returns valid UTF-8 with '?' for each control character except the line feed, so that it cannot control a terminal.
std::string withoutControls(std::string_view text);

// Returns ":LINE:COLUMN" of the byte `offset` in UTF-8, both from 1. Columns count characters.
std::string lineAndColumn(std::string_view text, std::size_t offset);

// Gives places of a text as lineAndColumn() does. Offsets in ascending order cost one pass through the text.
class LineCounter {
  public:
    explicit LineCounter(std::string_view text) : text_(text) {}

    std::string at(std::size_t offset);

  private:
    std::string_view text_;
    std::size_t offset_ = 0;
    std::size_t line_ = 1;
    std::size_t column_ = 1;
};

}  // namespace spherule
