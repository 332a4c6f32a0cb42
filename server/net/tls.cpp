#include "net/tls.h"

#include <openssl/ssl.h>

#include <boost/asio/buffer.hpp>

namespace spherule::net {

namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using boost::system::error_code;

Tls contextFor(ssl::context::method method) {
    auto context = std::make_shared<ssl::context>(method);
    SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
    SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION);
    return context;
}

tl::unexpected<Error> refuse(const char* where, const std::string& what, const error_code& error) {
    return fail(ErrorKind::Input, where, what + ": " + error.message());
}

}  // namespace

Result<Tls> serverTls(const Credentials& credentials) {
    Tls context = contextFor(ssl::context::tls_server);
    error_code error;
    context->use_certificate_chain(asio::buffer(credentials.certificate), error);
    if (error) return refuse("--tls-certificate", "is no chain of certificates in PEM form", error);
    // Without a callback, OpenSSL asks for the passphrase of an encrypted key on the terminal.
    context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
    context->use_private_key(asio::buffer(credentials.key), ssl::context::pem, error);
    if (error)
        return refuse("--tls-key", "is no private key in PEM form, without passphrase, of this certificate", error);
    if (SSL_CTX_check_private_key(context->native_handle()) != 1)
        return fail(ErrorKind::Input, "--tls-key", "is not the key of the certificate");
    return context;
}

Result<Tls> clientTls(const std::string& authorities) {
    Tls context = contextFor(ssl::context::tls_client);
    context->set_verify_mode(ssl::verify_peer);
    error_code error;
    if (authorities.empty())
        context->set_default_verify_paths(error);
    else
        context->add_certificate_authority(asio::buffer(authorities), error);
    if (error) return refuse("--ca", "has no certificate in PEM form", error);
    return context;
}

}  // namespace spherule::net
