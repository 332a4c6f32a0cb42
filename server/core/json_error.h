#pragma once

#include <string>
#include <string_view>

namespace spherule {

// An error of protobuf's JSON parser, in terms of the JSON text. Any thread.
struct JsonError {
    bool isJson = false;  // valid JSON with an unknown field or an invalid value
    std::string place;    // path of the field, or ":line:column" of a syntax error; empty: unknown
    std::string reason;
};

// `status`: the parser's error. `what`: the expected message, such as "a scene".
JsonError jsonErrorOf(std::string_view status, std::string_view text, std::string_view what);

}  // namespace spherule
