#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "compute/device.h"

namespace spherule::compute {

// Kernel sources given in the test.
class MapSources final : public SourceSet {
  public:
    using Files = std::map<std::string, std::string, std::less<>>;
    MapSources(std::initializer_list<Files::value_type> files) : files_(files) {}

    [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const override {
        const auto file = files_.find(name);
        if (file == files_.end()) return std::nullopt;
        return file->second;
    }

  private:
    Files files_;
};

}  // namespace spherule::compute
