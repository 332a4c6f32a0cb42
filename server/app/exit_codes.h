#pragma once

#include "core/result.h"

namespace spherule::app {

constexpr int exitDone = 0;
constexpr int exitInput = 2;  // usage or scene
constexpr int exitNoDevice = 3;
constexpr int exitRefused = 4;
constexpr int exitDiverged = 5;
constexpr int exitDeviceLost = 75;  // worth another start

constexpr const char* exitCodesText =
    "Exit codes: 0 done, 1 out of memory, 2 usage or scene, 3 no device, 4 refused, 5 a sphere left the numbers, 75 "
    "device lost.";

constexpr int exitCodeOf(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Input:
            return exitInput;
        case ErrorKind::NoDevice:
            return exitNoDevice;
        case ErrorKind::Refused:
            return exitRefused;
        case ErrorKind::DeviceLost:
            return exitDeviceLost;
        case ErrorKind::Diverged:
            return exitDiverged;
    }
    return exitInput;
}

}  // namespace spherule::app
