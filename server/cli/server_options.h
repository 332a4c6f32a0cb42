#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "core/result.h"
#include "net/server.h"

namespace spherule::cli {

// Options of the command line of a server: address, access and limits.
struct ServerOptions {
    std::string listen = "127.0.0.1:8080";
    std::string viewerTokenFile, controllerTokenFile;
    std::string certificateFile, keyFile;
    double watchdog = 0;  // s, see addWatchdog()
    net::Options net;     // without the address and the credentials

    void addTo(CLI::App& command);
};

// Adds --listen, with its default.
void addListen(CLI::App& command, std::string& listen);

// Returns true when there are files of credentials, which may change while the server runs.
bool hasFiles(const ServerOptions& options);
// All options, with the address and the credentials.
Result<net::Options> netOptionsOf(const ServerOptions& options);
// Reads the credentials from the files, or from SPHERULE_VIEWER_TOKEN and SPHERULE_CONTROLLER_TOKEN. Tokens are never
// arguments, because other users of the machine can see arguments.
Result<net::Credentials> credentialsOf(const ServerOptions& options);

}  // namespace spherule::cli
