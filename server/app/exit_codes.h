#pragma once

#include "core/result.h"

namespace spherule::app {

constexpr int exitDone = 0;
constexpr int exitFault = 1;  // of the program
constexpr int exitInput = 2;  // usage, scene or file
constexpr int exitNoDevice = 3;
constexpr int exitRefused = 4;
constexpr int exitDiverged = 5;
constexpr int exitDeviceLost = 75;  // worth another start
constexpr int exitBySignal = 128;   // plus its number: of a signal that ended the program before its work was done

constexpr const char* exitCodesText =
    "Exit codes: 0 done, 1 a fault of the program, 2 usage, scene or file, 3 no device, 4 refused (memory, disk, "
    "port), "
    "5 a sphere left the numbers, 75 the device was lost or hangs: worth another start, 129, 130 or 143 ended by a "
    "signal before it was done.";

constexpr int exitCodeOf(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Input:
            return exitInput;
        case ErrorKind::NoDevice:
            return exitNoDevice;
        case ErrorKind::Refused:
        case ErrorKind::Cancelled:
            return exitRefused;
        case ErrorKind::DeviceLost:
            return exitDeviceLost;
        case ErrorKind::Diverged:
            return exitDiverged;
    }
    return exitFault;
}

}  // namespace spherule::app
