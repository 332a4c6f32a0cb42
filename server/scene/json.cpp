#include "scene/json.h"

#include <google/protobuf/util/json_util.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/memory.h"
#include "scene/check.h"

namespace spherule::scene {

namespace {

// Protobuf names some fields as the .proto file does; the JSON name is what the writer of a scene knows.
std::string camelCase(std::string_view path) {
    std::string result;
    bool raise = false;
    for (const char c : path) {
        if (c != '_') result += raise ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        raise = c == '_';
    }
    return result;
}

// A syntax error comes as "reason\n<text around>\n<spaces>^". The text around is looked up in the whole to find the
// offset; none when it occurs more than once.
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

std::string lineAndColumn(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t newline = before.rfind('\n');
    const std::size_t column = newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
    return fmt::format(":{}:{}", line, column);
}

// Every other error comes as "(path) name: reason", where "(path)", "name" or both may be missing.
tl::unexpected<Error> fieldError(std::string_view message, std::string_view file) {
    std::string path;
    if (message.starts_with('(')) {
        const std::size_t end = std::min(message.find(')'), message.size() - 1);
        path = camelCase(message.substr(1, end - 1));
        message.remove_prefix(end + 1);
        if (message.starts_with(' ')) message.remove_prefix(1);
    }
    const std::size_t colon = message.find(": ");
    if (colon == std::string_view::npos)
        return fail(ErrorKind::Input, fmt::format("{}: {}", file, path), std::string(message));
    std::string_view reason = message.substr(colon + 2);
    if (colon > 0) path = at(path, camelCase(message.substr(0, std::min<std::size_t>(colon, 80))));
    if (reason == "Cannot find field.") reason = "is not a field of a scene";
    const std::string where = path.empty() ? std::string(file) : fmt::format("{}: {}", file, path);
    return fail(ErrorKind::Input, where, std::string(reason.substr(0, 200)));
}

// Bytes at most, beside the text: the message on its way, twice while it grows; then objects, and numbers in arrays
// that grow.
std::uint64_t costOf(std::string_view text) {
    constexpr std::uint64_t object = 200;
    constexpr std::uint64_t value = 24;
    const auto objects = static_cast<std::uint64_t>(std::ranges::count(text, '{'));
    const auto values = static_cast<std::uint64_t>(std::ranges::count(text, ','));
    return 2 * text.size() + object * objects + value * values;
}

}  // namespace

Result<v1::Scene> parseJson(const std::string& text, std::string_view file) {
    const auto claim = memory::Claim::make(std::string(file), "reading it", costOf(text));
    if (!claim) return tl::unexpected(claim.error());
    v1::Scene scene;
    const auto status = google::protobuf::util::JsonStringToMessage(text, &scene);
    if (status.ok()) return scene;
    const std::string_view message(status.message().data(), status.message().size());
    if (const auto syntax = syntaxOf(message, text)) {
        const std::string place = syntax->offset ? lineAndColumn(text, *syntax->offset) : "";
        return fail(ErrorKind::Input, std::string(file) + place, fmt::format("is not JSON: {}", syntax->reason));
    }
    return fieldError(message, file);
}

}  // namespace spherule::scene
