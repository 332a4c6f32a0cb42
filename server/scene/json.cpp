#include "scene/json.h"

#include <google/protobuf/util/json_util.h>
#include <spdlog/fmt/fmt.h>

#include "core/json_error.h"

namespace spherule::scene {

Result<v1::Scene> parseJson(const std::string& text, std::string_view file) {
    v1::Scene scene;
    const auto status = google::protobuf::util::JsonStringToMessage(text, &scene);
    if (status.ok()) return scene;
    const JsonError error = jsonErrorOf({status.message().data(), status.message().size()}, text, "a scene");
    const char* const separator = error.isJson ? ": " : "";
    return fail(ErrorKind::Input, fmt::format("{}{}{}", file, error.place.empty() ? "" : separator, error.place),
                error.reason);
}

}  // namespace spherule::scene
