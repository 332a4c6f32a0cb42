#pragma once

#include <stdexcept>
#include <utility>

#include "core/result.h"

namespace spherule::support {

// Returns the value of a result. Throws its error as std::runtime_error.
template <class T>
T valueOf(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
}

}  // namespace spherule::support
