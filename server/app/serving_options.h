#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "core/result.h"
#include "net/server.h"

namespace spherule::app {

// How a show is served, as the command line says: where, to whom, and how much of it.
struct ServingOptions {
    std::string listen = "127.0.0.1:8080";
    std::string viewerTokenFile, controllerTokenFile;
    std::string certificateFile, keyFile;
    double watchdog = 0;  // s, as addWatchdog says
    net::Options net;     // but for the address and the credentials

    void addTo(CLI::App& command);
};

// --listen, with its default.
void addListen(CLI::App& command, std::string& listen);

// Whether there are credentials that may change while it runs.
bool hasFiles(const ServingOptions& options);
// With address and credentials.
Result<net::Options> netOptionsOf(const ServingOptions& options);
// Of the files, as they are now, or of SPHERULE_VIEWER_TOKEN and SPHERULE_CONTROLLER_TOKEN: on the command line, other
// users of the machine would see them.
Result<net::Credentials> credentialsOf(const ServingOptions& options);

}  // namespace spherule::app
