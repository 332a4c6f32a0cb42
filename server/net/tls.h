#pragma once

#include <memory>
#include <string>

#include <boost/asio/ssl/context.hpp>

#include "core/result.h"
#include "net/credentials.h"

namespace spherule::net {

using Tls = std::shared_ptr<boost::asio::ssl::context>;

// Creates a server context with the certificate and key: TLS 1.2 or newer. Input if OpenSSL cannot use them, or the key
// does not belong to the certificate.
Result<Tls> serverTls(const Credentials& credentials);

// Creates a client context that trusts `authorities` (PEM); if empty, the authorities of the system. Input if they are
// no certificates.
Result<Tls> clientTls(const std::string& authorities);

}  // namespace spherule::net
