#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Text from outside, made fit for messages, logs and terminals.
namespace spherule {

// Valid UTF-8, which messages need: each byte that is none becomes U+FFFD. Names of files may be any bytes.
std::string utf8(std::string_view text);

// The first `most` bytes of UTF-8, or up to three fewer: a character is not cut.
std::string_view cutUtf8(std::string_view text, std::size_t most);

// Valid UTF-8 in which every control character but the line feed is '?': a terminal only shows it.
std::string withoutControls(std::string_view text);

}  // namespace spherule
