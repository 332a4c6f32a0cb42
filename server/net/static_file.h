#pragma once

#include <string>
#include <string_view>

namespace spherule::net {

// A file that does not change while the server runs, as it is and compressed.
struct StaticFile {
    struct Form {
        std::string_view bytes;
        std::string tag;  // for ETag, with quotes; differs between contents
    };

    std::string contentType;
    Form plain;
    Form gzip;
};

// Whether the client takes gzip. `acceptEncoding`: value of Accept-Encoding; clients without it may not know gzip.
bool acceptsGzip(std::string_view acceptEncoding);

// Whether the client has the form with this tag already. `ifNoneMatch`: value of If-None-Match.
bool isKnown(std::string_view ifNoneMatch, std::string_view tag);

}  // namespace spherule::net
