#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/format.h"

// The bytes of recordings, for tests that change them. `file`: the whole content of a file.
namespace spherule::recording {

// Returns the end of the record that begins at `at`; nullopt if it is cut off.
std::optional<std::size_t> endOfRecord(std::string_view file, std::size_t at);

// Returns the records, without the trailer.
std::vector<std::string> recordsOf(std::string_view file);

// Returns the kind, the time (s) and the payload of a record.
Kind kindOf(std::string_view record);
double timeOf(std::string_view record);
std::string_view payloadOf(std::string_view record);

// Adds a record. Its checksum is of its place in the file, and of the version and the id in the file's head.
void addRecord(std::string& file, Kind kind, double time, std::string_view payload);

// Gives all records the checksums of their places, up to one that is cut off.
void setChecksums(std::string& file);

}  // namespace spherule::recording
