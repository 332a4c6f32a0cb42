#include "net/decode.h"

#include <charconv>
#include <optional>
#include <string>

#include <google/protobuf/util/json_util.h>

#include "core/json_error.h"

namespace spherule::net {

namespace {

bool isNonFinite(std::string_view word) {
    if (word == "NaN" || word == "Infinity" || word == "-Infinity") return true;
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc::result_out_of_range && end == word.data() + word.size() &&
           word.find("e-") == std::string_view::npos && word.find("E-") == std::string_view::npos;
}

// Quotes bare NaN and Infinity, which many programs write and protobuf reads only in quotes. nullopt if there are none.
std::optional<std::string> quoteNonFinite(std::string_view text) {
    constexpr std::string_view wordCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.";
    std::string quoted;
    bool any = false;
    for (std::size_t k = 0; k < text.size();) {
        std::size_t end = k + 1;
        if (text[k] == '"') {
            for (; end < text.size() && text[end] != '"'; ++end)
                if (text[end] == '\\') ++end;
            end = std::min(end + 1, text.size());
        } else if (wordCharacters.find(text[k]) != std::string_view::npos) {
            end = std::min(text.find_first_not_of(wordCharacters, k), text.size());
        }
        const std::string_view token = text.substr(k, end - k);
        const bool bare = token.front() != '"' && isNonFinite(token);
        any = any || bare;
        quoted += bare ? '"' + std::string(token) + '"' : std::string(token);
        k = end;
    }
    return any ? std::optional(quoted) : std::nullopt;
}

// Removes the leading "command.", so that the path of a field of a command begins at the Command.
std::string pathOf(std::string_view place) {
    constexpr std::string_view command = "command.";
    return std::string(place.starts_with(command) ? place.substr(command.size()) : place);
}

Result<v1::ClientMessage> decodeText(std::string_view text) {
    v1::ClientMessage message;
    const auto status = google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message);
    if (status.ok()) return message;
    const JsonError error =
        jsonErrorOf({status.message().data(), status.message().size()}, text, "a message of spherule.v1");
    if (error.isJson) return fail(ErrorKind::Refused, pathOf(error.place), error.reason);
    return fail(ErrorKind::Input, "", "not the JSON form of a ClientMessage" + error.place + " " + error.reason);
}

}  // namespace

Result<v1::ClientMessage> decodeClientMessage(std::string_view bytes, Encoding encoding) {
    if (encoding == Encoding::Text) {
        auto message = decodeText(bytes);
        if (!message && message.error().kind == ErrorKind::Input)
            if (const auto quoted = quoteNonFinite(bytes)) return decodeText(*quoted);
        return message;
    }
    v1::ClientMessage message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        return fail(ErrorKind::Input, "", "not a ClientMessage of spherule.v1");
    message.DiscardUnknownFields();  // nothing reads them
    return message;
}

}  // namespace spherule::net
