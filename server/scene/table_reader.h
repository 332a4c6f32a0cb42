#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_file.h"
#include "scene/check.h"

namespace spherule::scene {

constexpr std::size_t longestTableLine = 4096;  // bytes, if no other limit is given

// Reads the lines of a text file and the numbers in them. Its errors contain the path, the line and the column.
class TableReader {
  public:
    // Opens the file; refuses if it cannot be opened. `field`: the field of the scene that names the file.
    TableReader(Check& check, std::string field, std::filesystem::path path);

    // Moves to the next line. Returns false at the end of the file, after any refusal, if the line cannot be read, and
    // if the work is cancelled. Reports the progress.
    bool nextLine(std::size_t mostBytes = longestTableLine);

    // Ends the line before the first `mark`, if it has one.
    void cutAt(char mark) { length_ = text().find(mark); }

    [[nodiscard]] std::string_view text() const {
        return lines_ ? std::string_view(lines_->line()).substr(0, length_) : "";
    }
    [[nodiscard]] std::size_t line() const { return lines_ ? lines_->number() : 1; }  // from 1
    [[nodiscard]] bool ok() const { return check_.ok(); }                             // nothing was refused

    // `column`: from 1. `word`: a part of text().
    void refuse(std::size_t column, std::string_view reason);
    void refuse(std::string_view word, std::string_view reason);
    void refuseLine(std::size_t line, std::string_view reason);

    // Returns the parts of the line between commas without blanks around them, or the words between blanks and tabs.
    // They are valid until the next line.
    [[nodiscard]] std::vector<std::string_view> cells() const;
    [[nodiscard]] std::vector<std::string_view> words() const;

    // Returns the number; refuses a word that is none, and a number that is not finite. One that is too small for a
    // double is 0. `name` begins the refusal.
    std::optional<double> number(std::string_view word, std::string_view name);
    // Returns a whole number from 0 to 2^53; otherwise refuses.
    std::optional<std::uint64_t> whole(std::string_view word, std::string_view name);

  private:
    Check& check_;
    std::string field_;
    std::filesystem::path path_;
    std::optional<LineReader> lines_;
    std::size_t length_ = std::string_view::npos;  // of the line, at most
};

}  // namespace spherule::scene
