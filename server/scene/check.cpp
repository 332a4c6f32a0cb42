#include "scene/check.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "scene/structure.h"

namespace spherule::scene {

namespace {

// Returns true if the value at `outer` contains the one at `inner`, or is the same.
bool contains(std::string_view outer, std::string_view inner) {
    if (!inner.starts_with(outer)) return false;
    return inner.size() == outer.size() || inner[outer.size()] == '.' || inner[outer.size()] == '[';
}

bool areRelated(std::string_view one, std::string_view other) {
    return contains(one, other) || contains(other, one);
}

double finiteOrZero(double value) {
    return std::isfinite(value) ? value : 0;
}

}  // namespace

bool Check::hasEnded() const {
    return cancelled_ || (keep_ == Keep::First ? !errors_.empty() : errors_.size() >= mostMistakes);
}

bool Check::isDoubtful(std::string_view path) const {
    return std::ranges::any_of(doubts_, [&](const std::string& doubt) { return areRelated(doubt, path); });
}

bool Check::isRight(std::string_view path) const {
    return !isDoubtful(path) &&
           std::ranges::none_of(errors_, [&](const Error& error) { return areRelated(error.where, path); });
}

void Check::refuse(std::string field, std::string reason, Cause cause, Limits limits) {
    refuse(Error{ErrorKind::Input, std::move(field), std::move(reason), cause, limits});
}

void Check::refuse(Error error) {
    if (!ok_) return;
    ok_ = false;
    const auto isSame = [&](const Error& other) {
        return other.where == error.where && other.message == error.message;
    };
    if (hasEnded() || isDoubtful(error.where) || std::ranges::any_of(errors_, isSame)) return;
    errors_.push_back(std::move(error));
}

bool Check::goesOn(const char* doing, std::size_t done, std::size_t of) {
    if (progress_ == nullptr) return ok();
    progress_->at(doing, of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 0);
    if (ok() && progress_->cancelled()) {
        refuse({ErrorKind::Cancelled, "", "was cancelled", Cause::Cancelled});
        cancelled_ = true;
    }
    return ok();
}

double Check::finite(double value, std::string_view field) {
    part([&] {
        if (!std::isfinite(value))
            refuse(std::string(field), fmt::format("is {}, must be a finite number", value), Cause::Range);
    });
    return finiteOrZero(value);
}

double Check::positive(double value, std::string_view field) {
    part([&] {
        finite(value, field);
        if (value <= 0)
            refuse(std::string(field), fmt::format("is {}, must be positive", value), Cause::Range,
                   {.least = 0, .most = {}});
    });
    return finiteOrZero(value);
}

double Check::within(double value, double low, double high, std::string_view field, std::string_view unit) {
    part([&] {
        finite(value, field);
        if (value < low || value > high)
            refuse(std::string(field), fmt::format("is {}, must be {} to {}{}", value, low, high, unit), Cause::Range,
                   {.least = low, .most = high});
    });
    return std::clamp(finiteOrZero(value), low, high);
}

double Check::upTo(double value, double high, std::string_view field, std::string_view unit) {
    part([&] {
        positive(value, field);
        if (value > high)
            refuse(std::string(field), fmt::format("is {}, must be at most {}{}", value, high, unit), Cause::Range,
                   {.least = 0, .most = high});
    });
    return std::min(finiteOrZero(value), high);
}

glm::dvec3 Check::vector(const Numbers& values, std::string_view field) {
    glm::dvec3 result{};
    part([&] {
        if (values.size() != 3)
            return refuse(std::string(field), fmt::format("has {} number{}, must have three: x, y, z", values.size(),
                                                          values.size() == 1 ? "" : "s"));
        for (int axis = 0; axis < 3; ++axis)
            result[axis] =
                within(values[axis], -largestComponent, largestComponent, at(field, static_cast<std::size_t>(axis)));
    });
    return result;
}

glm::dvec3 Check::vectorOr(const Numbers& values, glm::dvec3 absent, std::string_view field) {
    return values.empty() ? absent : vector(values, field);
}

Box Check::box(const Numbers& min, const Numbers& max, std::string_view field) {
    Box result;
    const bool right = part([&] {
        result = {vector(min, at(field, "min")), vector(max, at(field, "max"))};
        for (int axis = 0; axis < 3 && ok(); ++axis) {
            if (result.min[axis] < result.max[axis]) continue;
            refuse(at(at(field, "max"), static_cast<std::size_t>(axis)),
                   fmt::format("is {}, must be above min, which is {}", result.max[axis], result.min[axis]));
        }
    });
    return right ? result : Box();
}

void setVector(Numbers& numbers, const glm::dvec3& to) {
    numbers.Clear();
    for (int axis = 0; axis < 3; ++axis) numbers.Add(to[axis]);
}

std::string Check::colour(const std::string& value, std::string_view field) {
    const auto isHex = [](unsigned char c) { return std::isxdigit(c) != 0; };
    const bool good = value.size() == 7 && value[0] == '#' && std::all_of(value.begin() + 1, value.end(), isHex);
    if (!good && !value.empty()) {
        part([&] { refuse(std::string(field), fmt::format("is {}, must be #rrggbb in hexadecimal", shown(value))); });
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
