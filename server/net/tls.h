#pragma once

#include <memory>
#include <string>

#include <boost/asio/ssl/context.hpp>

#include "core/result.h"
#include "net/credentials.h"

namespace spherule::net {

using Tls = std::shared_ptr<boost::asio::ssl::context>;

// For a server with this certificate and key: TLS 1.2 and newer. A file that OpenSSL cannot use, or a key that is not
// the certificate's, is an error.
Result<Tls> serverTls(const Credentials& credentials);

// For a client that trusts what the system trusts, or, where `authorities` (PEM) are given, these alone.
Result<Tls> clientTls(const std::string& authorities);

}  // namespace spherule::net
