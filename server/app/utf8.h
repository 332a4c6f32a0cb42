#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace spherule::app {

// Fit for a message, which holds nothing but UTF-8: names of files may be any bytes. What is none becomes U+FFFD.
inline std::string utf8(const std::string& text) {
    using nlohmann::json;
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

}  // namespace spherule::app
