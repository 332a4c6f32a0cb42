#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <google/protobuf/repeated_field.h>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/result.h"
#include "scene/scene.h"

namespace spherule::scene {

using Numbers = google::protobuf::RepeatedField<double>;

// The largest coordinate (m) or other vector component allowed, far below the limit of float32.
constexpr double largestComponent = 1e9;

// Reads values of a message and keeps errors. Returns a harmless value in place of a refused one, so that the caller
// may check ok() later.
class Check {
  public:
    // First: only the first error, so that a refusal is cheap. All: the first one of each part; at most mostMistakes.
    enum class Keep : std::uint8_t { First, All };

    // `progress` may be null; otherwise it must outlive the check.
    explicit Check(Progress* progress = nullptr, Keep keep = Keep::First) : progress_(progress), keep_(keep) {}

    // Calls read(), within which ok() refers to its errors alone: other errors do not hide them. Parts may contain
    // parts. Returns true if nothing was refused in it. Does nothing and returns false after the end: see hasEnded().
    template <class Read>
    bool part(Read read);
    // Reads each entry of a list as a part: read(2, "groups[2]").
    template <class Read>
    void entries(std::string_view list, std::size_t count, Read read);
    // Returns true if no further part is read: after the first error, if only that is kept; after mostMistakes; and if
    // the work was cancelled.
    [[nodiscard]] bool hasEnded() const;

    // Names a value that is known to be wrong, and was left out. Errors at it, within it or around it are not kept.
    void doubt(std::string path) { doubts_.push_back(std::move(path)); }
    // Returns true if there is a doubt at the path, within it or around it.
    [[nodiscard]] bool isDoubtful(std::string_view path) const;
    // Returns true if there is neither a doubt nor an error at the path, within it or around it; without a path:
    // anywhere.
    [[nodiscard]] bool isRight(std::string_view path) const;
    [[nodiscard]] bool isRight() const { return errors_.empty() && doubts_.empty() && ok(); }

    void refuse(std::string field, std::string reason, Cause cause = Cause::Unspecified, Limits limits = {});
    void refuse(Error error);

    // Reports the progress of long work: `done` of `of` parts. Returns false if a value was refused, or if the work was
    // cancelled (error Cancelled).
    bool goesOn(const char* doing, std::size_t done, std::size_t of);

    // Each of these is a part.
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

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] tl::unexpected<Error> error() const {
        return tl::unexpected<Error>(errors_.empty() ? Error() : errors_.front());
    }
    [[nodiscard]] Cause lastCause() const { return errors_.empty() ? Cause::Unspecified : errors_.back().cause; }
    [[nodiscard]] const std::vector<Error>& errors() const { return errors_; }

  private:
    Progress* progress_;
    Keep keep_;
    bool ok_ = true;  // in the part that is read
    bool cancelled_ = false;
    std::vector<Error> errors_;
    std::vector<std::string> doubts_;
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

template <class Read>
bool Check::part(Read read) {
    if (hasEnded()) return false;
    const bool before = std::exchange(ok_, true);
    read();
    const bool right = ok_;
    ok_ = before && right;
    return right;
}

template <class Read>
void Check::entries(std::string_view list, std::size_t count, Read read) {
    for (std::size_t k = 0; k < count && !hasEnded(); ++k) part([&] { read(k, at(list, k)); });
}

}  // namespace spherule::scene
