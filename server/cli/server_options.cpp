#include "cli/server_options.h"

#include <utility>

#include "cli/option_values.h"
#include "cli/options.h"
#include "cli/secret_files.h"

namespace spherule::cli {

void addListen(CLI::App& command, std::string& listen) {
    listen = "127.0.0.1:8080";
    command.add_option("--listen", listen, "host:port; port 0 takes a free one")->capture_default_str();
}

void ServerOptions::addTo(CLI::App& command) {
    constexpr const char* group = "Access";
    addListen(command, listen);
    addWatchdog(command, watchdog);
    command.add_option("--viewer-token-file", viewerTokenFile, "file with the token of viewers")->group(group);
    command.add_option("--controller-token-file", controllerTokenFile, "file with the token of controllers")
        ->group(group);
    command.add_flag("--open", net.open, "let every client watch and command, on an address that other machines reach")
        ->group(group);
    command
        .add_option("--origin", net.allowedNames.origins,
                    "a site whose pages may open the stream, such as https://spherule.example.org")
        ->delimiter(',')
        ->expected(1)
        ->take_all()
        ->group(group);
    command.add_option("--host", net.allowedNames.hosts, "a name of this server, besides localhost and addresses")
        ->delimiter(',')
        ->expected(1)
        ->take_all()
        ->group(group);
    command.add_option("--tls-certificate", certificateFile, "certificate chain for TLS (PEM)")->group(group);
    command.add_option("--tls-key", keyFile, "private key of the certificate (PEM)")->group(group);

    constexpr const char* limits = "Limits (0: none)";
    command.add_option("--max-sessions", net.connectionLimits.sessions, "sessions at a time")
        ->capture_default_str()
        ->group(limits);
    command
        .add_option("--max-sessions-per-address", net.connectionLimits.sessionsPerAddress,
                    "sessions of one address at a time")
        ->capture_default_str()
        ->group(limits);
    command
        .add_option("--connections-per-second", net.connectionLimits.connectionsPerSecond,
                    "new connections of one address, on average")
        ->capture_default_str()
        ->check(finiteRate)
        ->group(limits);
    command.add_option("--commands-per-second", net.commandsPerSecond, "commands of one session, on average")
        ->capture_default_str()
        ->check(finiteRate)
        ->group(limits);
}

bool hasFiles(const ServerOptions& options) {
    return !options.viewerTokenFile.empty() || !options.controllerTokenFile.empty() || !options.certificateFile.empty();
}

Result<net::Credentials> credentialsOf(const ServerOptions& options) {
    auto viewer = tokenOf("--viewer-token-file", options.viewerTokenFile, "SPHERULE_VIEWER_TOKEN");
    if (!viewer) return tl::unexpected(viewer.error());
    auto controller = tokenOf("--controller-token-file", options.controllerTokenFile, "SPHERULE_CONTROLLER_TOKEN");
    if (!controller) return tl::unexpected(controller.error());
    if (!viewer->empty() && *viewer == *controller)
        return fail(ErrorKind::Input, "--viewer-token-file", "is the token of controllers, too: give each their own");
    if (options.certificateFile.empty() != options.keyFile.empty())
        return fail(ErrorKind::Input, options.keyFile.empty() ? "--tls-key" : "--tls-certificate",
                    "is missing: TLS needs a certificate and its key");
    auto certificate = contentOf("--tls-certificate", options.certificateFile);
    if (!certificate) return tl::unexpected(certificate.error());
    auto key = contentOf("--tls-key", options.keyFile);
    if (!key) return tl::unexpected(key.error());
    return net::Credentials{.viewerToken = std::move(*viewer),
                            .controllerToken = std::move(*controller),
                            .certificate = std::move(*certificate),
                            .key = std::move(*key)};
}

Result<net::Options> netOptionsOf(const ServerOptions& options) {
    const auto endpoint = endpointOf(options.listen);
    if (!endpoint) return tl::unexpected(endpoint.error());
    auto credentials = credentialsOf(options);
    if (!credentials) return tl::unexpected(credentials.error());
    if (options.net.open && net::requiresToken(*credentials))
        return fail(ErrorKind::Input, "--open", "lets everybody in, and a token keeps them out: give one of the two");
    net::Options result = options.net;
    result.host = endpoint->host;
    result.port = endpoint->port;
    result.credentials = std::move(*credentials);
    return result;
}

}  // namespace spherule::cli
