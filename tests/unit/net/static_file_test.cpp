#include "net/static_file.h"

#include <gtest/gtest.h>

namespace spherule::net {
namespace {

TEST(StaticFile, GzipIsAcceptedIfItIsNamed) {
    for (const char* const value : {"gzip", "GZip", "x-gzip", "deflate, gzip", "br,gzip;q=0.001", "gzip; Q=1", "*",
                                    "gzip, *;q=0", "identity;q=0.5, *;q=0.1", ", gzip"})
        EXPECT_TRUE(acceptsGzip(value)) << value;
}

TEST(StaticFile, GzipIsNotAcceptedOtherwise) {
    for (const char* const value : {"", "identity", "br, deflate", "gzipped", "gzip;q=0", "GZIP ; Q=0.000", "*;q=0",
                                    "gzip;q=0, *", "*, gzip;q=0", "gzip;q=", "br;gzip"})
        EXPECT_FALSE(acceptsGzip(value)) << value;
}

TEST(StaticFile, FormIsKnownIfItsTagIsInTheList) {
    const std::string tag = "\"12ab\"";
    for (const char* const value : {"\"12ab\"", "W/\"12ab\"", "\"0\", \"12ab\"", "\"0\",W/\"12ab\",\"x\"", "*"})
        EXPECT_TRUE(isKnown(value, tag)) << value;
    for (const char* const value : {"", "12ab", "\"12abc\"", "\"012ab\"", "\"12AB\"", "W/\"0\"", "\"*\"", "\"12ab"})
        EXPECT_FALSE(isKnown(value, tag)) << value;
}

}  // namespace
}  // namespace spherule::net
