#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compute/device.h"
#include "measure/figure.h"

namespace spherule::measure {

struct Options {
    std::string suite = "all";  // "all", "accuracy", "cost" or "stability"
    bool quick = false;
};

struct Report {
    std::string command;
    compute::DeviceInfo device;
    std::vector<Outcome> outcomes;
};

// Called with the name of the case that starts.
using Progress = std::function<void(const std::string& what)>;

// Runs every case of the suite with its models and rungs. Fails only when the device is lost; other errors are part of
// the report.
Result<Report> measure(compute::Device& device, const Options& options, const Progress& progress);

// Returns model and factor, such as "balanced x2".
std::string nameOf(const Rung& rung);

// The files of a report.
std::string csvOf(const Report& report);       // one row per figure
std::string markdownOf(const Report& report);  // tables for people
std::string jsonOf(const Report& report);      // errors and cost per model and rung, and all verdicts

// A chart of one work-precision curve: error against cost, one line per model.
struct Plot {
    std::string name;  // of the curve, and of the file with '-' for ' '
    std::string svg;
};
std::vector<Plot> plotsOf(const Report& report);

// Creates the folder if it is missing. Input if it cannot be written.
Result<void> checkFolder(const std::string& folder);
// Writes all files of the report into the folder.
Result<void> write(const Report& report, const std::string& folder);

}  // namespace spherule::measure
