// Fuzzes functions on short texts of clients: hosts, origins, tokens, URLs, quantities and log texts.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "client/url.h"
#include "core/quantity.h"
#include "net/admission.h"
#include "net/sanitize.h"

namespace {

using namespace spherule;

void require(bool holds) {
    if (!holds) std::abort();
}

void comeIn(const std::string& text) {
    static const net::Admission gate({.hosts = {"spherule.example.org"}, .origins = {"https://example.org:8443"}},
                                     {.viewerToken = "0123456789abcdef", .controllerToken = "fedcba9876543210"},
                                     "http");
    // An accepted host is a configured name or an address.
    if (gate.isHost(text)) require(net::checkHost(text).has_value());
    if (gate.isOrigin(text, "localhost:8080")) require(net::checkOrigin(text).has_value());
    require(gate.roleOf(text).has_value() == (text == "0123456789abcdef" || text == "fedcba9876543210"));
    if (net::checkToken(text, "")) require(text.size() >= 16);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    comeIn(text);
    if (const auto url = client::parseUrl(text))
        require(!url->host.empty() && !url->port.empty() && !url->path.empty());
    (void)quantityOf(text);
    require(net::closeReason(text).size() <= 123);
    require(std::ranges::all_of(net::sanitize(text), [](char c) { return c >= ' ' && c <= '~'; }));
    return 0;
}
