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

// The largest coordinate (m) or other vector component allowed, far below the limit of float32.
constexpr double largestComponent = 1e9;

// Reads values of a message and keeps the first error; later errors are not reported. Returns a harmless value in place
// of a refused one, so that the caller may check ok() later.
class Check {
  public:
    // `progress` may be null; otherwise it must outlive the check.
    explicit Check(Progress* progress = nullptr) : progress_(progress) {}

    void refuse(std::string field, std::string reason, Cause cause = Cause::Unspecified, Limits limits = {});
    void refuse(Error error);

    // Reports the progress of long work: `done` of `of` parts. Returns false if a value was refused, or if the work was
    // cancelled (error Cancelled).
    bool goesOn(const char* doing, std::size_t done, std::size_t of);

    double finite(double value, std::string_view field);
    double positive(double value, std::string_view field);
    // Requires low <= value <= high. `unit` follows the limits in the message.
    double within(double value, double low, double high, std::string_view field, std::string_view unit = "");
    // Requires a value above zero and at most `high`.
    double upTo(double value, double high, std::string_view field, std::string_view unit);
    // Requires exactly three finite numbers, none beyond largestComponent.
    glm::dvec3 vector(const Numbers& values, std::string_view field);
    glm::dvec3 vectorOr(const Numbers& values, glm::dvec3 absent, std::string_view field);
    // Reads `field`.min and `field`.max. Requires min below max on every axis.
    Box box(const Numbers& min, const Numbers& max, std::string_view field);
    // Requires "#rrggbb" or an empty text.
    std::string colour(const std::string& value, std::string_view field);

    [[nodiscard]] bool ok() const { return error_.message.empty(); }
    [[nodiscard]] tl::unexpected<Error> error() const { return tl::unexpected<Error>(error_); }

  private:
    Progress* progress_;
    Error error_;
};

// Sets the numbers of a message's vector.
void setVector(Numbers& numbers, const glm::dvec3& to);

// Returns "groups[2]" for "groups" and 2.
std::string at(std::string_view field, std::size_t index);

// Returns "groups[2].fill" for "groups[2]" and "fill", or "fill" if `field` is empty.
std::string at(std::string_view field, std::string_view member);

// Returns external text, quoted and cut to a length fit for a message.
std::string shown(std::string_view text);

std::string shown(const glm::dvec3& v);

}  // namespace spherule::scene
