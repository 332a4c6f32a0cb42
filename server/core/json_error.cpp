#include "core/json_error.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/text.h"

namespace spherule {

namespace {

// Protobuf reports some fields with the name of the .proto file; the JSON text uses the JSON name.
std::string camelCase(std::string_view path) {
    std::string result;
    bool raise = false;
    for (const char c : path) {
        if (c != '_') result += raise ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        raise = c == '_';
    }
    return result;
}

// A syntax error has the form "reason\n<nearby text>\n<spaces>^". The offset is found by searching for the nearby text;
// nullopt if it occurs more than once.
struct Syntax {
    std::string_view reason;
    std::optional<std::size_t> offset;
};

std::optional<Syntax> syntaxOf(std::string_view message, std::string_view text) {
    const std::size_t first = message.find('\n');
    const std::size_t last = message.rfind('\n');
    if (first == std::string_view::npos || !message.ends_with('^')) return std::nullopt;
    const std::string_view around = first == last ? "" : message.substr(first + 1, last - first - 1);
    const std::size_t caret = message.size() - last - 2;
    Syntax syntax{message.substr(0, first), std::nullopt};
    if (around.empty()) {
        syntax.offset = text.size();
    } else if (const std::size_t found = text.find(around);
               found != std::string_view::npos && found == text.rfind(around)) {
        syntax.offset = found + caret;
    }
    return syntax;
}

// Other errors have the form "(path) name: reason", where "(path)", "name" or both may be missing.
JsonError misfit(std::string_view message, std::string_view what) {
    constexpr std::size_t longestName = 80;
    constexpr std::size_t longestReason = 200;
    std::string path;
    if (message.starts_with('(')) {
        const std::size_t end = std::min(message.find(')'), message.size() - 1);
        path = camelCase(message.substr(1, end - 1));
        message.remove_prefix(end + 1);
        if (message.starts_with(' ')) message.remove_prefix(1);
    }
    std::string reason = utf8(message);
    if (const std::size_t colon = message.find(": "); colon != std::string_view::npos) {
        const std::string name = camelCase(cutUtf8(message.substr(0, colon), longestName));
        if (!name.empty()) path += path.empty() ? name : "." + name;
        reason = utf8(message.substr(colon + 2));
    }
    if (reason == "Cannot find field.") reason = fmt::format("is not a field of {}", what);
    return {.isJson = true, .place = utf8(path), .reason = std::string(cutUtf8(reason, longestReason))};
}

}  // namespace

JsonError jsonErrorOf(std::string_view status, std::string_view text, std::string_view what) {
    const auto syntax = syntaxOf(status, text);
    if (!syntax) return misfit(status, what);
    return {.isJson = false,
            .place = syntax->offset ? lineAndColumn(text, *syntax->offset) : "",
            .reason = fmt::format("is not JSON: {}", utf8(syntax->reason))};
}

}  // namespace spherule
