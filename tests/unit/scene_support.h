#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/load.h"

namespace spherule::scene::testing {

// A scene in the unit cube with these further members, as JSON: `"step": 0.01, "groups": []`.
Result<Scene> builtWith(std::string_view members, const Overrides& overrides = {});

// The scene, or a failed test and an empty one.
Scene sceneWith(std::string_view members, const Overrides& overrides = {});

// The text of the refusal, or "accepted".
std::string refusalOf(std::string_view members, const Overrides& overrides = {});

// Members in braces.
std::string object(std::string_view members);

// One group with these members.
std::string group(std::string_view members);

v1::Scene parsed(const std::string& json);

// A folder for one test, removed after it.
class Folder {
  public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    // The path of a new file.
    [[nodiscard]] std::string write(std::string_view name, std::string_view text) const;
    // What a path in it is called.
    [[nodiscard]] std::string path(std::string_view name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

}  // namespace spherule::scene::testing
