#include "scene/check.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace spherule::scene {

void Check::refuse(std::string field, std::string reason, Cause cause, Limits limits) {
    refuse(Error{ErrorKind::Input, std::move(field), std::move(reason), cause, limits});
}

void Check::refuse(Error error) {
    if (ok()) error_ = std::move(error);
}

bool Check::goesOn(const char* doing, std::size_t done, std::size_t of) {
    if (progress_ == nullptr) return ok();
    progress_->at(doing, of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 0);
    if (ok() && progress_->cancelled()) error_ = {ErrorKind::Cancelled, "", "was cancelled", Cause::Cancelled};
    return ok();
}

double Check::finite(double value, std::string_view field) {
    if (std::isfinite(value)) return value;
    refuse(std::string(field), fmt::format("is {}, must be a finite number", value), Cause::Range);
    return 0;
}

double Check::positive(double value, std::string_view field) {
    if (std::isfinite(value) && value <= 0)
        refuse(std::string(field), fmt::format("is {}, must be positive", value), Cause::Range,
               {.least = 0, .most = {}});
    return finite(value, field);
}

double Check::within(double value, double low, double high, std::string_view field, std::string_view unit) {
    value = finite(value, field);
    if (value < low || value > high) {
        refuse(std::string(field), fmt::format("is {}, must be {} to {}{}", value, low, high, unit), Cause::Range,
               {.least = low, .most = high});
    }
    return std::clamp(value, low, high);
}

double Check::upTo(double value, double high, std::string_view field, std::string_view unit) {
    value = positive(value, field);
    if (value > high)
        refuse(std::string(field), fmt::format("is {}, must be at most {}{}", value, high, unit), Cause::Range,
               {.least = 0, .most = high});
    return std::min(value, high);
}

glm::dvec3 Check::vector(const Numbers& values, std::string_view field) {
    if (values.size() != 3) {
        refuse(std::string(field),
               fmt::format("has {} number{}, must have three: x, y, z", values.size(), values.size() == 1 ? "" : "s"));
        return {};
    }
    glm::dvec3 result{};
    for (int axis = 0; axis < 3; ++axis) {
        result[axis] =
            within(values[axis], -largestComponent, largestComponent, at(field, static_cast<std::size_t>(axis)));
    }
    return result;
}

glm::dvec3 Check::vectorOr(const Numbers& values, glm::dvec3 absent, std::string_view field) {
    return values.empty() ? absent : vector(values, field);
}

Box Check::box(const Numbers& min, const Numbers& max, std::string_view field) {
    const Box result{vector(min, at(field, "min")), vector(max, at(field, "max"))};
    if (!ok()) return {};
    for (int axis = 0; axis < 3; ++axis) {
        if (result.min[axis] < result.max[axis]) continue;
        refuse(at(at(field, "max"), static_cast<std::size_t>(axis)),
               fmt::format("is {}, must be above min, which is {}", result.max[axis], result.min[axis]));
    }
    return result;
}

void setVector(Numbers& numbers, const glm::dvec3& to) {
    numbers.Clear();
    for (int axis = 0; axis < 3; ++axis) numbers.Add(to[axis]);
}

std::string Check::colour(const std::string& value, std::string_view field) {
    const auto isHex = [](unsigned char c) { return std::isxdigit(c) != 0; };
    const bool good = value.size() == 7 && value[0] == '#' && std::all_of(value.begin() + 1, value.end(), isHex);
    if (!good && !value.empty()) {
        refuse(std::string(field), fmt::format("is {}, must be #rrggbb in hexadecimal", shown(value)));
    }
    return value;
}

std::string at(std::string_view field, std::size_t index) {
    return fmt::format("{}[{}]", field, index);
}

std::string at(std::string_view field, std::string_view member) {
    return field.empty() ? std::string(member) : fmt::format("{}.{}", field, member);
}

std::string shown(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result = "\"";
    for (const char c : text.substr(0, longest)) {
        const bool plain = std::isprint(static_cast<unsigned char>(c)) != 0;
        result += plain ? c : '?';
    }
    return result + (text.size() > longest ? "...\"" : "\"");
}

std::string shown(const glm::dvec3& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

}  // namespace spherule::scene
