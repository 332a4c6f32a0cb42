#include "scene/hints.h"

#include <vector>

#include <spdlog/fmt/fmt.h>

#include "core/suggestion.h"
#include "scene/field_rules.h"

namespace spherule::scene {

std::string didYouMean(std::string_view word, std::span<const std::string> names) {
    const auto nearest = suggestionFor(word, names);
    return nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : "";
}

std::string otherOwnersOf(std::string_view field, const google::protobuf::Descriptor& message) {
    constexpr std::size_t most = 2;
    std::vector<std::string> owners;
    for (const google::protobuf::Descriptor* const one : messagesOfScene())
        for (int k = 0; k < one->field_count() && one != &message; ++k)
            if (one->field(k)->json_name() == field) owners.push_back(one->name());
    if (owners.empty() || owners.size() > most) return "";
    return fmt::format("; {} {} one of this name", fmt::join(owners, " and "), owners.size() == 1 ? "has" : "have");
}

}  // namespace spherule::scene
