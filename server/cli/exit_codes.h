#pragma once

#include "core/result.h"

namespace spherule::cli {

constexpr int exitDone = 0;
constexpr int exitFault = 1;  // fault of the program
constexpr int exitInput = 2;  // wrong usage, scene or file
constexpr int exitNoDevice = 3;
constexpr int exitRefused = 4;
constexpr int exitDiverged = 5;
constexpr int exitDiffers = 6;      // two runs differ
constexpr int exitDeviceLost = 75;  // a new start may help
constexpr int exitBySignal = 128;   // plus the number of the signal that ended the program early

constexpr const char* exitCodesText =
    "Exit codes:\n"
    "  0                                          done\n"
    "  1                                          fault of the program\n"
    "  2                                          wrong usage, scene or file\n"
    "  3                                          no device\n"
    "  4                                          refused: memory, disk, port\n"
    "  5                                          non-finite position or velocity\n"
    "  6                                          two runs differ\n"
    "  75                                         device lost or hanging; start again\n"
    "  129, 130, 143                              ended early by a signal";

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

}  // namespace spherule::cli
