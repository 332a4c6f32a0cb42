#include "net/static_file.h"

#include <algorithm>
#include <optional>

#include <boost/beast/http/rfc7230.hpp>

namespace spherule::net {

namespace beast = boost::beast;

namespace {

bool isZero(beast::string_view weight) {
    return weight.find_first_not_of("0.") == beast::string_view::npos;
}

}  // namespace

bool acceptsGzip(std::string_view acceptEncoding) {
    std::optional<bool> named;
    std::optional<bool> others;
    for (const auto& [coding, parameters] :
         beast::http::ext_list(beast::string_view(acceptEncoding.data(), acceptEncoding.size()))) {
        const bool accepted = std::none_of(parameters.begin(), parameters.end(), [](const auto& parameter) {
            return beast::iequals(parameter.first, "q") && isZero(parameter.second);
        });
        if (beast::iequals(coding, "gzip") || beast::iequals(coding, "x-gzip")) named = accepted;
        if (coding == "*") others = accepted;
    }
    return named.value_or(others.value_or(false));
}

bool isKnown(std::string_view ifNoneMatch, std::string_view tag) {
    // Only the tag itself contains its quotes, so it can be searched for. The comparison is weak: "W/" is ignored.
    return ifNoneMatch == "*" || ifNoneMatch.find(tag) != std::string_view::npos;
}

}  // namespace spherule::net
