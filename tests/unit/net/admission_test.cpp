#include "net/admission.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace spherule::net {
namespace {

const std::string viewers = "viewers-token-of-a-test";
const std::string controllers = "controllers-token-of-a-test";

Admission plain(AllowedNames allowedNames = {}) {
    return {std::move(allowedNames), {}, "http"};
}

TEST(Admission, AcceptsHostNamesOfThisServer) {
    const Admission here = plain({.hosts = {"Spherule.Example.org", "other.example:8443"}});
    for (const std::string host :
         {"localhost", "localhost:8080", "LOCALHOST", "127.0.0.1:8080", "[::1]:8080", "10.1.2.3",
          "spherule.example.org", "spherule.example.org:80", "SPHERULE.example.org", "other.example:8443"})
        EXPECT_TRUE(here.isHost(host)) << host;
    for (const std::string host :
         {"", "evil.example", "localhost.evil.example", "xspherule.example.org", "spherule.example.org.evil.example",
          "other.example", "other.example:8444", "127.0.0.1.evil.example", "localhost:", "localhost:80x", "[::1", "a b",
          "localhost:8080:9", "::1", "[evil.example]:80", "localhost\t"})
        EXPECT_FALSE(here.isHost(host)) << host;
}

TEST(Admission, AcceptsListedOrigins) {
    const Admission here = plain({.origins = {"https://Spherule.example.org"}});
    EXPECT_TRUE(here.isOrigin("http://localhost:8080", "localhost:8080"));
    EXPECT_TRUE(here.isOrigin("https://spherule.example.org", "localhost:8080"));
    EXPECT_TRUE(here.isHost("spherule.example.org")) << "the host of an accepted origin is accepted";
    for (const std::string origin : {"null", "http://localhost", "http://localhost:8081", "https://localhost:8080",
                                     "http://evil.example", "http://spherule.example.org",
                                     "https://spherule.example.org:444", "https://spherule.example.org.evil.example",
                                     "https://evil-spherule.example.org", "https://spherule.example.org/"})
        EXPECT_FALSE(here.isOrigin(origin, "localhost:8080")) << origin;
}

TEST(Admission, GrantsRoleForToken) {
    EXPECT_EQ(plain().roleOf(""), v1::CONTROLLER) << "without tokens every client is a controller";
    const Admission both({}, {.viewerToken = viewers, .controllerToken = controllers}, "http");
    EXPECT_EQ(both.roleOf(viewers), v1::VIEWER);
    EXPECT_EQ(both.roleOf(controllers), v1::CONTROLLER);
    for (const std::string& token :
         {std::string(), viewers + "x", viewers.substr(1), controllers + std::string(1, '\0')})
        EXPECT_FALSE(both.roleOf(token)) << token;
    const Admission watched({}, {.viewerToken = viewers}, "http");
    EXPECT_FALSE(watched.roleOf("")) << "an unset token does not match an empty one";
    const Admission steered({}, {.controllerToken = controllers}, "http");
    EXPECT_FALSE(steered.roleOf(""));
}

TEST(Admission, RefusesInvalidHostsOriginsAndTokens) {
    EXPECT_TRUE(checkOrigin("https://spherule.example.org:8443"));
    EXPECT_TRUE(checkOrigin("http://[::1]:8080"));
    for (const std::string origin : {"", "*", "spherule.example.org", "https://", "https://a/", "https://*.example.org",
                                     "https://a:b", "ftp://a", "https://a b"})
        EXPECT_FALSE(checkOrigin(origin)) << origin;
    for (const std::string host : {"", "*", "*.example.org", "http://a", "a:", "a b", "a/b"})
        EXPECT_FALSE(checkHost(host)) << host;
    EXPECT_TRUE(checkToken(viewers, "here"));
    for (const std::string& token : {std::string("short"), std::string(16, ' '), std::string(16, '\n'),
                                     std::string(257, 'x'), std::string("0123456789abcde\xc3")})
        EXPECT_FALSE(checkToken(token, "here")) << token;
}

}  // namespace
}  // namespace spherule::net
