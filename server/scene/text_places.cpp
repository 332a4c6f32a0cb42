#include "scene/text_places.h"

#include <algorithm>

namespace spherule::scene {

namespace {

// Takes the first step from a path.
std::string_view takeStep(std::string_view& path) {
    if (path.starts_with('.')) path.remove_prefix(1);
    const std::size_t end = std::min(path.find_first_of(".[", 1), path.size());
    const std::string_view step = path.substr(0, end);
    path.remove_prefix(end);
    return step;
}

}  // namespace

void TextPlaces::add(std::string_view path) {
    Node* node = &root_;
    while (!path.empty()) node = &node->parts[std::string(takeStep(path))];
}

std::size_t TextPlaces::offsetOf(std::string_view path) const {
    const Node* node = &root_;
    std::size_t offset = 0;
    while (node->offset) {
        offset = *node->offset;
        if (path.empty()) break;
        const auto next = node->parts.find(takeStep(path));
        if (next == node->parts.end()) break;
        node = &next->second;
    }
    return offset;
}

}  // namespace spherule::scene
