#include "core/text.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>
#include <nlohmann/json.hpp>

namespace spherule {

namespace {

bool continuesCharacter(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

std::string utf8(std::string_view text) {
    using nlohmann::json;
    return json::parse(json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

std::string_view cutUtf8(std::string_view text, std::size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && continuesCharacter(text[most])) --most;
    return text.substr(0, most);
}

std::string withoutControls(std::string_view text) {
    constexpr unsigned char leadOfC1 = 0xC2;  // U+0080 to U+009F are this byte and one from 0x80 to 0x9F
    const std::string valid = utf8(text);
    std::string plain;
    for (std::size_t k = 0; k < valid.size(); ++k) {
        const auto c = static_cast<unsigned char>(valid[k]);
        if (c == leadOfC1 && static_cast<unsigned char>(valid[k + 1]) < 0xA0) {
            plain += '?';
            ++k;
        } else {
            const bool control = c < ' ' || c == 0x7F;
            plain += control && c != '\n' ? '?' : valid[k];
        }
    }
    return plain;
}

std::string lineAndColumn(std::string_view text, std::size_t offset) {
    return LineCounter(text).at(offset);
}

std::string LineCounter::at(std::size_t offset) {
    if (offset < offset_) *this = LineCounter(text_);
    for (const std::size_t end = std::min(offset, text_.size()); offset_ < end; ++offset_) {
        if (text_[offset_] == '\n') {
            ++line_;
            column_ = 1;
        } else if (!continuesCharacter(text_[offset_])) {
            ++column_;
        }
    }
    return fmt::format(":{}:{}", line_, column_);
}

}  // namespace spherule
