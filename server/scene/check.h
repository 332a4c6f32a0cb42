#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <google/protobuf/repeated_field.h>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/result.h"
#include "scene/scene.h"

namespace spherule::scene {

using Numbers = google::protobuf::RepeatedField<double>;

// No coordinate, in m, and no other component of a vector may be larger; far inside what float32 holds.
constexpr double largestComponent = 1e9;

// Reads values of a message and keeps the first that cannot be accepted; what is refused after it is not reported.
// A refused value comes back as a harmless one, so that reading may go on to the next ok().
class Check {
  public:
    // `progress` may be null; otherwise it must outlive the check.
    explicit Check(Progress* progress = nullptr) : progress_(progress) {}

    void refuse(std::string field, std::string reason);
    void refuse(Error error);

    // Says how far long work has come: `done` of `of` parts. False once something was refused, or the work is to end:
    // Cancelled.
    bool goesOn(const char* doing, std::size_t done, std::size_t of);

    double finite(double value, std::string_view field);
    double positive(double value, std::string_view field);
    // low <= value <= high; `unit` follows the limits in the message.
    double within(double value, double low, double high, std::string_view field, std::string_view unit = "");
    // Above zero, at most `high`.
    double upTo(double value, double high, std::string_view field, std::string_view unit);
    // Exactly three finite numbers, none beyond largestComponent.
    glm::dvec3 vector(const Numbers& values, std::string_view field);
    glm::dvec3 vectorOr(const Numbers& values, glm::dvec3 absent, std::string_view field);
    // `field`.min and `field`.max, min below max on every axis.
    Box box(const Numbers& min, const Numbers& max, std::string_view field);
    // "#rrggbb" or empty.
    std::string colour(const std::string& value, std::string_view field);

    [[nodiscard]] bool ok() const { return error_.message.empty(); }
    [[nodiscard]] tl::unexpected<Error> error() const { return tl::unexpected<Error>(error_); }

  private:
    Progress* progress_;
    Error error_;
};

// "groups" and 2: "groups[2]".
std::string at(std::string_view field, std::size_t index);

// "groups[2]" and "fill": "groups[2].fill"; just "fill" when `field` is empty.
std::string at(std::string_view field, std::string_view member);

// Text from outside, quoted and cut to a length fit for a message.
std::string shown(std::string_view text);

std::string shown(const glm::dvec3& v);

}  // namespace spherule::scene
