#include "scene/json.h"

#include <google/protobuf/util/json_util.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "core/json_error.h"
#include "core/memory.h"

namespace spherule::scene {

namespace {

// Returns the most memory (bytes) for parsing, in addition to the text: the binary message, twice while it grows, then
// objects, and numbers in growing arrays.
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
    const JsonError error = jsonErrorOf({status.message().data(), status.message().size()}, text, "a scene");
    const char* const separator = error.isJson ? ": " : "";
    return fail(ErrorKind::Input, fmt::format("{}{}{}", file, error.place.empty() ? "" : separator, error.place),
                error.reason);
}

}  // namespace spherule::scene
