#include "methods.h"

namespace spherule::bench {

Result<std::unique_ptr<Baseline>> bruteForce(const Setting& setting) {
    auto method = std::make_unique<Baseline>(setting, Baseline::State::PingPong);
    method->response("brute_force.comp", {});
    if (auto ready = method->ready(); !ready) return tl::unexpected(ready.error());
    return method;
}

}  // namespace spherule::bench
