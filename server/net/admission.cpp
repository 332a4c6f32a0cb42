#include "net/admission.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include <boost/asio/ip/address.hpp>

namespace spherule::net {

namespace {

constexpr std::size_t shortestToken = 16;
constexpr std::size_t longestToken = 256;

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

// Removes port and brackets.
std::string_view nameOf(std::string_view host) {
    if (host.starts_with('[')) {
        const auto end = host.find(']');
        return end == std::string_view::npos ? host : host.substr(1, end - 1);
    }
    return host.substr(0, host.find(':'));
}

bool isPort(std::string_view text) {
    return !text.empty() && text.size() <= 5 &&
           std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isName(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_';
    });
}

// make_address() stops at a zero byte and accepts any text as a zone.
bool isAddress(std::string_view name) {
    const auto zone = name.find('%');
    if (zone != std::string_view::npos && !isName(name.substr(zone + 1))) return false;
    if (name.find('\0') != std::string_view::npos) return false;
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(name), error);
    return !error;
}

bool isHostAndPort(std::string_view host) {
    const std::string_view name = nameOf(host);
    const bool bracketed = host.starts_with('[');
    if (bracketed ? !isAddress(name) : !isName(name)) return false;
    const std::string_view rest = host.substr(name.size() + (bracketed ? 2 : 0));
    return rest.empty() || (rest.starts_with(':') && isPort(rest.substr(1)));
}

std::string_view hostOf(std::string_view origin) {
    return origin.substr(std::min(origin.size(), origin.find("://") + 3));
}

bool same(std::string_view given, const std::string& wanted) {
    return given.size() == wanted.size() && CRYPTO_memcmp(given.data(), wanted.data(), wanted.size()) == 0;
}

}  // namespace

Result<void> checkOrigin(const std::string& origin) {
    const std::string text = lower(origin);
    if ((text.starts_with("http://") || text.starts_with("https://")) && isHostAndPort(hostOf(text))) return {};
    return fail(
        ErrorKind::Input, "--origin",
        "is \"" + origin + "\"; give scheme, name and, if it has one, port, such as https://spherule.example.org");
}

Result<void> checkHost(const std::string& host) {
    if (isHostAndPort(host)) return {};
    return fail(ErrorKind::Input, "--host", "is \"" + host + "\"; give a name, such as spherule.example.org");
}

Result<void> checkToken(const std::string& token, const std::string& where) {
    if (token.size() < shortestToken || token.size() > longestToken)
        return fail(ErrorKind::Input, where,
                    "the token has " + std::to_string(token.size()) + " characters; give " +
                        std::to_string(shortestToken) + " to " + std::to_string(longestToken) +
                        ", for example from: openssl rand -hex 16");
    if (std::ranges::all_of(token, [](unsigned char c) { return c > ' ' && c <= '~'; })) return {};
    return fail(
        ErrorKind::Input, where,
        "the token may have only printable ASCII characters without spaces; make one with: openssl rand -hex 16");
}

Admission::Admission(AllowedNames allowedNames, Credentials credentials, std::string scheme)
    : allowed_(std::move(allowedNames)),
      viewerToken_(std::move(credentials.viewerToken)),
      controllerToken_(std::move(credentials.controllerToken)),
      scheme_(std::move(scheme)) {
    for (auto* list : {&allowed_.hosts, &allowed_.origins})
        for (std::string& entry : *list) entry = lower(entry);
    for (const std::string& origin : allowed_.origins) allowed_.hosts.emplace_back(hostOf(origin));
}

bool Admission::isHost(std::string_view host) const {
    const std::string given = lower(host);
    if (!isHostAndPort(given)) return false;
    const std::string name(nameOf(given));
    if (name == "localhost" || isAddress(name)) return true;
    return std::ranges::any_of(allowed_.hosts, [&](const std::string& one) { return one == given || one == name; });
}

bool Admission::isOrigin(std::string_view origin, std::string_view host) const {
    const std::string given = lower(origin);
    if (given == scheme_ + "://" + lower(host)) return true;
    return std::ranges::find(allowed_.origins, given) != allowed_.origins.end();
}

std::optional<v1::Role> Admission::roleOf(std::string_view token) const {
    if (!asksForToken()) return v1::CONTROLLER;
    // Always compare both, so that the time does not reveal which token matched.
    const bool controls = !controllerToken_.empty() && same(token, controllerToken_);
    const bool views = !viewerToken_.empty() && same(token, viewerToken_);
    if (controls) return v1::CONTROLLER;
    if (views) return v1::VIEWER;
    return std::nullopt;
}

}  // namespace spherule::net
