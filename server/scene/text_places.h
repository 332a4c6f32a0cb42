#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace spherule::scene {

// The places in a JSON text of values whose paths are known, such as "groups[0].list". One pass through the text finds
// all of them.
class TextPlaces {
  public:
    // A value on the way of a path. Steps are "list" and "[2]".
    struct Node {
        std::map<std::string, Node, std::less<>> parts;
        std::optional<std::size_t> offset;  // in the text; nullopt: not found

        [[nodiscard]] Node* part(std::string_view step) {
            const auto found = parts.find(step);
            return found == parts.end() ? nullptr : &found->second;
        }
    };

    void add(std::string_view path);
    [[nodiscard]] Node& root() { return root_; }
    // Returns the offset of the value, or of the nearest value that would contain it.
    [[nodiscard]] std::size_t offsetOf(std::string_view path) const;

  private:
    Node root_{.parts = {}, .offset = 0};
};

}  // namespace spherule::scene
