#pragma once

#include <string>
#include <string_view>

namespace spherule {

// Why protobuf's JSON parser refuses a text, in words for the writer of the text.
struct JsonError {
    bool isJson = false;  // the text is JSON, and a field of it does not fit
    std::string place;    // the path of that field, or the ":line:column" of what is not JSON; empty: unknown
    std::string reason;
};

// `status` is the parser's message; `what` names the message that was wanted, such as "a scene".
JsonError jsonErrorOf(std::string_view status, std::string_view text, std::string_view what);

}  // namespace spherule
